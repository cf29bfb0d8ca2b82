"""Change the speed and the direction of a walk while it goes on.

Run it with `python examples/live_speed.py`. A guide is asked once a step what to do; `Steady` says
the same until its `order` is replaced, here by a callback, elsewhere by a gamepad or a planner.
"""

from math import radians

from windup import Robot
from windup.control.steering.guide import Steady, WalkCommand

PLAN = {
    1: WalkCommand(speed=0.1),
    20: WalkCommand(speed=0.25),
    40: WalkCommand(speed=0.1, turn=radians(20.0)),
    60: WalkCommand(stop=True),
}
"""From which step on what is commanded: m/s, rad/s (positive to the left)."""
STEPS = 70


def main() -> dict[int, float]:
    """Walk by the plan; return the speed at the end of each step, m/s."""
    guide = Steady(PLAN[1])
    speeds: dict[int, float] = {}

    def on_step(number: int, speed: float) -> None:
        """Record a step that has ended, and command what is due."""
        speeds[number] = speed
        guide.order = PLAN.get(number, guide.order)

    with Robot.open("op3") as robot:
        report = robot.walk(steps=STEPS, guide=guide, on_step=[on_step])
        print(report)
    for first, last in ((10, 20), (30, 40), (65, 70)):
        mean = sum(speeds[n] for n in range(first, last)) / (last - first)
        print(f"steps {first} to {last}: {mean:.2f} m/s")
    return speeds


if __name__ == "__main__":
    main()
