"""Conditions that must be refused before torque is switched on, each tried once."""

from collections.abc import Sequence
from typing import Any

from windup.tools.benches.safety.attempt import trial
from windup.tools.benches.safety.moment import Moment
from windup.tools.benches.safety.row import Row
from windup.tools.benches.safety.trial import PATIENCE
from windup.tools.terminal.output import console

AT_REST = Moment("standing", 0.0)


def _nothing(_: object) -> float:
    return 0.0


REFUSALS: tuple[tuple[str, dict[str, str], bool, int], ...] = (
    ("not armed", {}, False, 2),
    ("a servo is dead", {"": "dead:ids=13"}, True, 3),
    ("a servo is at 75 C", {"": "heat:ids=13:degrees=75"}, True, 3),
    ("supply is low", {"op3": "brown_out:volts=9:seconds=inf",
                       "duck": "brown_out:volts=5.5:seconds=inf"}, True, 3),
)  # fmt: skip
"""Each condition, the faults that cause it (robot to text), whether armed, and exit status."""
NETWORK = ("Feetech behind a network", 2)


def measure_refusals(robots: Sequence[str]) -> dict[str, Any]:
    """Return each refusal's exit status and message, and whether a motor was driven."""
    result: dict[str, Any] = {}
    for robot in robots:
        for what, faults, arm, status in REFUSALS:
            text = faults.get(robot, faults.get("", ""))
            result[f"{robot}: {what}"] = _refused(robot, text, arm, status, network=False)
    if "duck" in robots:
        what, status = NETWORK
        result[f"duck: {what}"] = _refused("duck", "", True, status, network=True)
    return result


def _refused(robot: str, faults: str, arm: bool, status: int, *, network: bool) -> dict[str, Any]:
    row = Row("refusal", _nothing, (status,), network=network)
    with trial(robot, row, AT_REST, arm, faults) as running:
        running.program.join(PATIENCE)
        running.journal.listen(0.1)
        driven = any(event.value > 0 for event in running.journal.since(0.0, "driven"))
        said, found = running.errors(), running.program.exitcode
    right = found == status and not driven
    console.print(f"{robot}: {said}: {'refused' if right else 'NOT REFUSED'}", soft_wrap=True)
    return {"right": right, "status": found, "driven": driven, "said": said}
