"""Pushing a twin that stands or walks."""

from dataclasses import dataclass, field
from typing import Annotated, Any, Literal

import numpy as np
import tyro

from windup.control.stepping.stepping_file import Support
from windup.hal.controller import Controller, Predictor
from windup.hal.errors import UsageError
from windup.hal.ranges import Range
from windup.robots import RobotDescription
from windup.sim_twin.impact import ImpactGauge
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.catching import supervisor_for
from windup.tools.assembly.forbid import forbidden
from windup.tools.assembly.shape import check_walks
from windup.tools.assembly.stepping import build_stepper, check_way, find_stepping, stepping_stance
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.behaviours.behaviour import Behaviour
from windup.tools.behaviours.landings import format_landings
from windup.tools.behaviours.push_trial import PushPlan, push_robot
from windup.tools.behaviours.push_walk import format_push_walk, push_walking
from windup.tools.behaviours.report import Report
from windup.tools.behaviours.run_record import RunRecord
from windup.tools.measures.fall_report import fall_result, format_fall
from windup.tools.robot.robot import Robot
from windup.tools.terminal.quantities import Degrees, Delay, Duration, Height, Seconds, Some, Speed

Strength = Annotated[float, Range(0.0, 10_000.0, "N s")]


@dataclass(frozen=True, kw_only=True)
class PushOptions:
    """Options of pushing."""

    impulse: Strength | None = None
    """Impulse, N s."""
    direction: Degrees | Literal["random"] = 0.0
    """Where to, degrees: 0 forward, 90 to the left; random draws one for each push."""
    duration: Duration = 0.1
    """How long a push lasts, s."""
    height: Height | None = None
    """Where it meets the body, m above the ground; its centre of mass by default."""
    body: str | None = None
    """Which body is pushed; the torso by default."""
    at: Seconds | None = None
    """When the first push begins, s; 1 in a stand and 4 in a walk by default."""
    during: Literal["stand", "walk"] = "stand"
    """What the robot is at."""
    speed: Speed | None = None
    """Speed of the walk, m/s; the gait's default otherwise."""
    catch: bool = True
    """Hand over to the stepper what the walk cannot absorb."""
    times: Some = 1
    """How many pushes."""
    every: Duration = 1.0
    """From one push to the next, s."""
    way: str | None = None
    """How the robot meets it: hold, feet, capture, ip, momentum or predictive; that of its stepping
    by default."""
    stance: str | None = None
    """Pose to stand in; that of the robot's stepping by default."""
    delay: Delay | None = None
    """Delay of the servos, s."""
    support: Support | None = None
    """What the soles are taken to support: the hull of their points, or Kenwright's circles and
    capsule; what its stepping says by default."""
    forbid: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """Ground where no foot may come down, such as a hole: X,Y,R (circle), X,Y,W,H (rectangle about
    X,Y) or X1,Y1,X2,Y2,X3,Y3,.. (polygon), m, seen from between the feet at the start; several."""

    def plan_for(self, robot: RobotDescription, seed: int) -> PushPlan:
        """Return what is done to a robot with a seed.

        Raises:
            UsageError: The robot has no stepping.toml.
        """
        directions: list[float] = [0.0 if self.direction == "random" else self.direction]
        directions *= self.times
        if self.direction == "random":
            draw = np.random.default_rng([11, seed])
            directions = draw.uniform(-180.0, 180.0, self.times).round(1).tolist()
        first = 1.0 if self.during == "stand" else 4.0
        return PushPlan(
            way=self.way or find_stepping(robot).way,
            impulse=self.impulse or 0.0,
            directions=tuple(directions),
            duration=self.duration,
            height=self.height,
            at=first if self.at is None else self.at,
            every=self.every,
            body=self.body,
            stance=self.stance,
            forbid=self.forbid,
            support=self.support,
        )

    def walk_options(self, plan: PushPlan) -> WalkOptions:
        """Return how the robot walks that is pushed as planned."""
        return WalkOptions(speed=self.speed, catch=self.catch, way=plan.way)


@dataclass
class Pushed:
    """What is measured of a robot that is pushed.

    Attributes:
        fall: Looks at how it falls.
        result: How it went.
    """

    fall: ImpactGauge
    result: dict[str, Any] = field(
        default_factory=lambda: {"reason": "interrupted", "survived": False}
    )


class Push(Behaviour[PushOptions]):
    """Push a robot; it survives when only feet touch the ground and it rests, or walks on."""

    name, Options, done = "push", PushOptions, "stayed up"

    def build(
        self, robot: RobotDescription, options: PushOptions, predictor: Predictor | None
    ) -> Controller:
        """Return what meets the push."""
        plan = options.plan_for(robot, 0)
        if options.during == "walk":
            walk = options.walk_options(plan)
            walker = build_walk(robot, walk, predictor)
            return supervisor_for(robot, walker, walk) or walker
        stance = stepping_stance(robot, plan.stance)
        return build_stepper(robot, plan.way, stance, forbidden(plan.forbid), plan.support)

    def check(self, robot: RobotDescription, options: PushOptions) -> None:
        """Check the options; see `Behaviour.check`."""
        check_walks(robot, "bear pushes")
        _check_during(options)
        forbidden(options.forbid)
        if options.way is not None:
            check_way(options.way)
        stepping_stance(robot, options.stance)
        super().check(robot, options)

    def opening(self, robot: RobotDescription, options: PushOptions) -> dict[str, Any]:
        """Return the delay of the servos, and the rate of the stepper."""
        steps = options.during == "stand" or options.catch
        return {"delay": options.delay, "rate": find_stepping(robot).rate if steps else None}

    def perform(self, run: RunRecord[PushOptions]) -> None:
        """Push the robot; one that falls does so to the end."""
        robot = run.robot
        run.measured = pushed = Pushed(ImpactGauge(robot.twin))
        plan = run.options.plan_for(robot.description, robot.seed)
        pushed.result = push(robot, run.options, plan, to_the_end=True)

    def report(self, run: RunRecord[PushOptions]) -> Report:
        """Return whether it stayed up."""
        pushed: Pushed = run.measured
        result = {"seed": run.robot.seed} | pushed.result | fall_result(pushed.fall)
        lines = [format_push(result)]
        if "landings" in result:
            lines.append(format_landings(result))
        good = result["survived"] and not result.get("on_forbidden")
        return Report(good, result["reason"], result, tuple(lines))


def push(
    robot: Robot, options: PushOptions, plan: PushPlan, *, to_the_end: bool = False
) -> dict[str, Any]:
    """Push an open robot that stands or walks, and return how it went.

    Raises:
        UsageError: A body or a height that the robot does not have.
        WindupError: From the loop.
    """
    if options.during == "stand":
        return push_robot(robot, plan, to_the_end=to_the_end)
    return push_walking(robot, plan, options.walk_options(plan), to_the_end=to_the_end)


def _check_during(options: PushOptions) -> None:
    """Raise what only a robot that stands, or one that walks, can do."""
    if options.during == "walk":
        names = ("stance", "forbid", "support")
        wrong = [name for name in names if getattr(options, name)]
        what = "is for a robot that stands; leave --during walk away"
    else:
        wrong = [] if options.speed is None else ["speed"]
        what = "is for a robot that walks; give --during walk"
    if wrong:
        raise UsageError(f"--{wrong[0]} {what}")


def format_push(row: dict[str, Any]) -> str:
    """Return the sentence of one trial."""
    if "robot" not in row:
        return "interrupted"
    toward = ", ".join(f"{direction:g}" for direction in row["directions"])
    push = f"{row['impulse']:g} N s toward {toward} degrees"
    steps = f"{row['steps']} steps" if row["steps"] != 1 else "1 step"
    if not row["survived"]:
        how = f"fell onto {row['touched'][0]}" if row["touched"] else row["reason"]
        return f"{row['robot']} {how} after {push} ({row['way']}, {steps}); {format_fall(row)}"
    if "during" in row:
        return f"{row['robot']} walks on after {push} ({row['way']}): {format_push_walk(row)}"
    return (
        f"{row['robot']} stays up after {push} ({row['way']}): {steps}, still after "
        f"{row['settling_s']:.2f} s, feet {1000 * row['astray_m']:.0f} mm from the stance"
    )


PUSH = Push()
