"""`windup status`: how the runtimes of this user are."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import msgspec
import tyro

from windup.hal.stopping.folder import private_folder
from windup.tools.remote.client import RuntimeClient
from windup.tools.remote.messages import Status as Answer
from windup.tools.remote.messages import Welcome
from windup.tools.remote.place import Place
from windup.tools.stopping.stop_runs import robot_name
from windup.tools.terminal.command import Command
from windup.tools.terminal.output import console, write_json


@dataclass(frozen=True, kw_only=True)
class Status(Command):
    """Show what a robot that is up does, or all that are."""

    robot: Annotated[str | None, tyro.conf.Positional, tyro.conf.arg(metavar="[ROBOT]")] = None
    """Name of the robot, or path of its folder; all by default."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""

    def run(self) -> int:
        """Show it; returns the exit status.

        Raises:
            UsageError: The robot is not up.
        """
        names = _robots_up() if self.robot is None else [robot_name(self.robot)]
        rows = []
        for name in names:
            with RuntimeClient(name, "windup status") as client:
                welcome, status = client.welcome, client.status()
            console.print(format_status(welcome, status), markup=False, soft_wrap=True)
            rows.append(_record(welcome, status))
        if not rows:
            console.print("no robot is up", markup=False)
        write_json(self.json, "status", {"rows": rows} if self.robot is None else rows[0])
        return 0


def format_status(welcome: Welcome, status: Answer) -> str:
    """Return the line for people about a runtime."""
    where = "its twin" if welcome.port is None else welcome.port
    torque = "torque on" if status.armed else "torque off"
    doing = f" ({status.behaviour})" if status.behaviour else ""
    lease = f"; {status.holder} has it" if status.holder else ""
    goals = ", ".join(f"{name} {count}" for name, count in status.counts.items() if count)
    return (
        f"{welcome.robot} on {where}: {status.state}{doing}, {torque}, {welcome.rate_hz:g} Hz, "
        f"{status.missed} of {status.ticks + status.missed} ticks late{lease}"
        f"{f'; goals: {goals}' if goals else ''}"
    )


def _record(welcome: Welcome, status: Answer) -> dict[str, Any]:
    about = {"robot": welcome.robot, "port": welcome.port, "pid": welcome.pid}
    told: dict[str, Any] = msgspec.to_builtins(status)
    del told["type"], told["id"]
    return {**about, "version": welcome.version, "rate_hz": welcome.rate_hz, **told}


def _robots_up() -> list[str]:
    """Return the names of the robots that are up, for this user."""
    places = [
        Place(path.stem, path, path.with_suffix(".socket"))
        for path in sorted(private_folder().glob("*.runtime"))
    ]
    return [place.robot for place in places if place.note() is not None]
