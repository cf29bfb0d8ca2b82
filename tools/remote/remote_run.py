"""A behaviour run by a runtime, from a command with --up."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec

from windup.tools.remote.client import RuntimeClient
from windup.tools.remote.messages import Ended
from windup.tools.stopping.stop_keys import keyboard, stop_keys
from windup.tools.stopping.stop_runs import stop_runs
from windup.tools.terminal.output import console, write_json

LOOK = 0.05
"""Time between two looks at the keyboard, s."""


def run_remotely(
    robot: str, behaviour: str, options: dict[str, Any], *, arm: bool, json: Path | None
) -> int:
    """Run a behaviour on the robot that is up, and say how it went; return the exit status.

    The space bar and q stop the robot. Ctrl-C ends the behaviour, and the robot is held.

    Args:
        robot: Name of the robot.
        behaviour: Name of the behaviour.
        options: Its options as plain data.
        arm: Switch torque on again after a stop.
        json: File for the result, or None.

    Raises:
        WindupError: The robot is not up, or the behaviour cannot be; nothing has moved.
    """
    with RuntimeClient(robot, f"windup {behaviour}") as client, stop_keys(keyboard()) as pressed:
        welcome, status = client.welcome, client.status()
        where = "its twin" if welcome.port is None else welcome.port
        off = "armed, torque still off" if welcome.may_arm else "not armed"
        torque = "armed" if status.armed else off
        console.print(f"{robot} on {where}, {torque}", markup=False, soft_wrap=True)
        number = client.run(behaviour, options, arm=arm)
        ended = _wait(client, number, pressed)
    for line in ended.lines:
        console.print(line, markup=False, soft_wrap=True)
    write_json(json, behaviour, ended.result)
    return ended.exit_status


def _wait(client: RuntimeClient, number: int, pressed: Callable[[], str | None]) -> Ended:
    """Wait for the end of a behaviour; a key stops the robot, and Ctrl-C ends the behaviour."""
    try:
        while (ended := client.ended(number, LOOK)) is None:
            if pressed() is not None:
                stop_runs(client.welcome.robot)
        return ended
    except KeyboardInterrupt:
        client.end()
        return msgspec.structs.replace(client.wait(number), exit_status=130)
