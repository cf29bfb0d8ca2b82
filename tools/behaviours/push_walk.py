"""A push on a walking twin, and whether it walks on afterwards."""

from math import ceil
from typing import Any

from windup.control.motions.play import PoseHolder
from windup.sim_twin.ground.touch import TouchWatch
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.behaviours.push_trial import LANDING, PushPlan, arrange
from windup.tools.robot.robot import Robot

QUICK = 0.2
"""No step takes less time, s."""
MORE = 20
"""Steps to walk after the last push, at least."""


def push_walking(
    robot: Robot, plan: PushPlan, options: WalkOptions, *, to_the_end: bool = False
) -> dict[str, Any]:
    """Let a fresh twin walk, push it, and return how it went.

    Args:
        robot: The robot.
        plan: What is done to it; its `at` is counted from the walk's beginning.
        options: How to walk, and whether steps catch what the walk cannot absorb.
        to_the_end: Let a robot that falls do so until it lies.

    Raises:
        UsageError: A body or a height that the robot does not have, or it cannot walk so.
        WindupError: From the loop.
    """
    description, twin = robot.description, robot.twin
    touch = TouchWatch(description, twin.model, twin.data)
    robot.watch.append(look := lambda _: touch.update())
    begun: list[float] = []

    def disturb(robot: Robot) -> None:
        begun.append(robot.twin.time)
        arrange(robot, plan)

    steps = ceil(plan.end / QUICK) + MORE
    report = robot.walk(steps=steps, options=options, disturb=disturb)
    robot.watch.remove(look)
    if to_the_end and robot.fallen and not robot.protect:
        stiff = PoseHolder(description.joints, description.stance, ramp=0.0)
        robot.run(stiff, LANDING, down=True)
    supervisor, walked = report.supervisor, report.walker.steps
    catches = [] if supervisor is None else supervisor.catches
    fell = report.fell or bool(touch.touched)
    return {
        "robot": description.name,
        "during": "walk",
        "way": plan.way if options.catch else "walk",
        "impulse": plan.impulse,
        "directions": list(plan.directions),
        "seed": robot.seed,
        "survived": report.done and not fell,
        "reason": "fell" if fell else report.loop.reason,
        "touched": touch.touched,
        "pushed_at": [begun[0] + plan.at + n * plan.every for n in range(len(plan.directions))],
        "steps": sum(catch.steps for catch in catches),
        "walked": walked,
        "speed_m_s": report.speed,
        "catches": [catch.record(walked) for catch in catches],
        "tick_ms": report.loop.tick_ms(),
    }


def format_push_walk(row: dict[str, Any]) -> str:
    """Return how a robot that stayed up took the pushes on its walk."""
    if not row["catches"]:
        return f"its walk absorbs it: {row['walked']} steps walked"
    return "; ".join(_caught(catch) for catch in row["catches"])


def _caught(catch: dict[str, Any]) -> str:
    begun = catch["handed_over_at"]
    steps = f"{catch['steps']} steps" if catch["steps"] != 1 else "1 step"
    line = f"handed over at {begun:.2f} s, {steps}"
    if catch["stood_at"] is not None:
        line += f", stood still at {catch['stood_at']:.2f} s"
    if catch["handed_back_at"] is not None:
        line += f", walked on at {catch['handed_back_at']:.2f} s: {catch['walked_after']} steps"
    return line
