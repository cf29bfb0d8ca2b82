"""Starts a robot from random poses, and checks that it starts and that faults in it are noticed."""

from collections import Counter
from collections.abc import Sequence
from typing import Any

from windup.robots import load_robot
from windup.tools.benches.starts.faults import FAULTS, Fault
from windup.tools.benches.starts.postures import Kind, kinds_of
from windup.tools.benches.starts.trial import MAX_FAULT_MOTION, Start, try_start
from windup.tools.terminal.parallel import run_parallel

SHARE = 4
"""Factor by which there are fewer starts with each fault than without any."""
ON_FEET: tuple[Kind, ...] = ("standing", "squatting")
SHOWN: dict[Fault, tuple[Kind, ...]] = {
    "sign": ON_FEET,
    "swap": ON_FEET,
    "jam": (*ON_FEET, "hanging"),
    "motor": (*ON_FEET, "hanging"),
}
"""Postures in which a fault can show in the first motion; a fault in the file only does so with the
feet on the floor. A robot that gets up first holds its pose, and moves many joints only later."""


def measure_starts(name: str, starts: int = 100, seed: int = 0) -> dict[str, Any]:
    """Return the results of random starts of a robot, without a fault and with one.

    A robot that lies or sits must report that when it is to stand, and then get up if it can. Any
    other refusal is a *false refusal*, since the robot can start from all other postures.

    Args:
        name: The robot.
        starts: Number of starts without a fault; a quarter as many with each fault.
        seed: Seed of the first start; the seeds of the others follow it.
    """
    robot = load_robot(name)
    kinds = kinds_of(robot)
    sound = [Start(name, kinds[n % len(kinds)], seed + n) for n in range(starts)]
    broken = []
    for fault in FAULTS:
        where, count = SHOWN[fault], range(max(starts // SHARE, 1))
        broken += [Start(name, where[n % len(where)], seed + n, fault) for n in count]
    rows = [row for _, row in run_parallel(try_start, sound + broken, label="starts")]
    result = _sound([row for row in rows if row["fault"] is None], "get_up_front" in robot.gaits())
    for fault in FAULTS:
        result[fault] = _broken([row for row in rows if row["fault"] == fault])
    late = sum(result[fault]["late"] for fault in FAULTS)
    return result | {"met": result["false_refusals"] == 0 and late == 0}


def _sound(rows: Sequence[dict[str, Any]], rises: bool) -> dict[str, Any]:
    """Return the summary of starts without a fault."""
    down = [row for row in rows if row["kind"] in ("sitting", "lying")]
    told = [row for row in down if row["told"]]
    refused = [row for row in rows if row["outcome"] in ("refused", "first motion")]
    right = [] if rises else [row for row in told if row["outcome"] == "refused"]
    return {
        "starts": len(rows),
        "down": len(down),
        "told": len(told),
        "false_refusals": len(refused) - len(right),
        "first_motion_errors": sum(row["outcome"] == "first motion" for row in rows),
        "falls": sum(row["outcome"] == "fell" for row in rows),
        "outcomes": dict(Counter(f"{row['kind']}: {row['outcome']}" for row in rows)),
        "said": [row["said"] for row in rows if row["outcome"] not in ("done", "refused")],
    }


def _broken(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return the summary of starts with one fault.

    "late": it did harm, or moved its joint by more than 15 degrees, before it was caught, or was
    not caught. "unseen": not caught, because it had no effect. "moved": the largest motion of a
    joint before its fault was caught, degrees.
    """
    ends = ("refused", "first motion", "UnhealthyError")
    caught = [row for row in rows if row["outcome"] in ends]
    early = [row for row in caught if row["moved"] <= MAX_FAULT_MOTION]
    unseen = [row for row in rows if row not in caught and not row["harm"]]
    late = [row for row in rows if row not in early and row not in unseen]
    return {
        "starts": len(rows),
        "caught": len(early),
        "named": sum(any(name in row["said"] for name in row["joints"]) for row in early),
        "moved": max((row["moved"] for row in early), default=0.0),
        "unseen": len(unseen),
        "late": len(late),
        "late_ones": [_sentence(row) for row in late],
    }


def _sentence(row: dict[str, Any]) -> str:
    """Return a description of one start."""
    joints, moved = " and ".join(row["joints"]), row["moved"]
    return f"{row['kind']} {row['seed']}, {joints}, moved {moved:.0f} degrees: {row['said']}"
