"""Push a standing robot, and compare what it can do about that.

Run it with `python examples/push_and_step.py`. The push is 0.1 s long and meets the torso. Each
trial is a fresh twin: one that holds its pose, one that balances with the pressure of its feet, and
one that takes steps.
"""

from typing import Any

from windup import Robot
from windup.tools.behaviours.push_trial import PushPlan, push_robot

IMPULSE = 1.8
"""N s; OP3 weighs 3.2 kg."""
DIRECTION = 0.0
"""Degrees: 0 pushes forward, 90 to the left."""
WAYS = ("hold", "feet", "predictive")


def trial(way: str) -> dict[str, Any]:
    """Push a fresh OP3 that meets the push in this way; return how it went."""
    with Robot.open("op3") as robot:
        robot.protect = False  # no soft landing: this is about staying up
        return push_robot(robot, PushPlan(way, IMPULSE, (DIRECTION,)))


def main() -> dict[str, dict[str, Any]]:
    """Try each way; return way to result."""
    results = {way: trial(way) for way in WAYS}
    for way, result in results.items():
        if result["survived"]:
            settling = result["settling_s"]
            print(f"{way:12s} stays up, steps: {result['steps']}, still after {settling:.2f} s")
        else:
            print(f"{way:12s} {result['reason']}")
    return results


if __name__ == "__main__":
    main()
