"""Conditions that must be refused before torque is switched on, each tried once."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from windup.tools.benches.safety.attempt import trial
from windup.tools.benches.safety.moment import Moment
from windup.tools.benches.safety.row import Ending
from windup.tools.benches.safety.trial import PATIENCE
from windup.tools.terminal.output import console

AT_REST = Moment("standing", 0.0)


def _nothing(_: object) -> float:
    return 0.0


@dataclass(frozen=True)
class Refusal:
    """A condition that must be refused.

    Attributes:
        what: The condition.
        faults: The faults that cause it; robot to text, "" for all others.
        status: The correct exit status.
        reason: Words of the correct message.
        arm: Whether the program arms the robot.
        network: Whether the robot is connected by TCP.
    """

    what: str
    faults: dict[str, str]
    status: int
    reason: str
    arm: bool = True
    network: bool = False


REFUSALS = (
    Refusal("not armed", {}, 2, "give --arm", arm=False),
    Refusal("a servo is dead", {"": "dead:ids=13"}, 3, "no answer"),
    Refusal("a servo is at 75 C", {"": "heat:ids=13:degrees=75"}, 3, "at 75 degrees C"),
    Refusal(
        "supply is low",
        {"op3": "brown_out:volts=9:seconds=inf", "duck": "brown_out:volts=5.5:seconds=inf"},
        3,
        "(stop below ",
    ),
)
NETWORK = Refusal("Feetech behind a network", {}, 2, "have no bus watchdog", network=True)


def measure_refusals(robots: Sequence[str]) -> dict[str, Any]:
    """Return each refusal's exit status and message, and whether a motor was driven."""
    result: dict[str, Any] = {}
    for robot in robots:
        for refusal in REFUSALS:
            result[f"{robot}: {refusal.what}"] = _refused(robot, refusal)
    if "duck" in robots:
        result[f"duck: {NETWORK.what}"] = _refused("duck", NETWORK)
    return result


def _refused(robot: str, refusal: Refusal) -> dict[str, Any]:
    row = Ending("refusal", _nothing, (refusal.status,), network=refusal.network)
    faults = refusal.faults.get(robot, refusal.faults.get("", ""))
    with trial(robot, row, AT_REST, refusal.arm, faults) as running:
        running.program.join(PATIENCE)
        running.journal.listen(0.1)
        driven = any(event.value > 0 for event in running.journal.since(0.0, "driven"))
        said, found = running.errors(), running.program.exitcode
    right = found == refusal.status and refusal.reason in said and not driven
    console.print(f"{robot}: {said}: {'refused' if right else 'NOT REFUSED'}", soft_wrap=True)
    return {"right": right, "status": found, "driven": driven, "said": said}
