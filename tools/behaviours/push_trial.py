"""One push on a twin, and whether the robot still stands afterwards."""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import nan, radians
from typing import Any

import numpy as np

from windup.control.kinematics.rotation import turn
from windup.control.motions.play import PoseHolder
from windup.control.stepping.stepper import Stepper
from windup.control.stepping.stepping_file import Support
from windup.hal.controller import Controller
from windup.hal.errors import UsageError
from windup.hal.joints import Array
from windup.hal.observation import Observation
from windup.sim_twin.ground.touch import TouchWatch
from windup.sim_twin.push import Push
from windup.tools.assembly.forbid import forbidden
from windup.tools.assembly.stepping import build_stepper, footing_of, stepping_stance
from windup.tools.behaviours.landings import Landings
from windup.tools.robot.robot import Robot

STILL = 0.05
"""Speed of the base of a robot that stands still, m/s."""
AFTER = 3.0
"""How long after the last push it has to, s."""
LONGEST = 5.0
"""How much longer a comfort step that it is at may take, s."""
Look = Callable[[Observation, Controller], None]
LANDING = 1.5
"""From a stiff fall being seen to lying, s."""


@dataclass(frozen=True)
class PushPlan:
    """What is done to a robot that stands.

    Attributes:
        way: How it meets the push; one of `windup.tools.assembly.stepping.WAYS`.
        impulse: N s.
        directions: Of one push after the other, degrees.
        duration: Of a push, s.
        height: Above the ground, m; None is the torso's centre of mass.
        at: When the first push begins, s.
        every: From one push to the next, s.
        body: Which body is pushed; the torso by default.
        stance: Name of the pose that it stands in; that of its stepping by default.
        support: What its soles are taken to support; that of its stepping by default.
        forbid: Ground where no foot may come down; see `windup.tools.assembly.forbid`.
    """

    way: str
    impulse: float
    directions: tuple[float, ...] = (0.0,)
    duration: float = 0.1
    height: float | None = None
    at: float = 1.0
    every: float = 1.0
    body: str | None = None
    stance: str | None = None
    forbid: tuple[str, ...] = ()
    support: Support | None = None

    @property
    def end(self) -> float:
        """When the last push is over, s."""
        return self.at + self.every * (len(self.directions) - 1) + self.duration


@dataclass
class PushWatch:
    """Looks at a robot under pushes, at every tick.

    Attributes:
        plan: The pushes.
        touch: What touches the ground.
        controller: Who controls.
        to_the_end: Does a touch of anything but a foot leave the run going?
        look: Called at every tick, for whoever draws.
        landings: Where the feet come down, if anybody asks.
        still: Since when the base is still, s; nan while it moves.
        seen: The last observation.
    """

    plan: PushPlan
    touch: TouchWatch
    controller: Controller
    to_the_end: bool = False
    look: Look | None = None
    landings: Landings | None = None
    still: float = nan
    seen: list[Observation] = field(default_factory=list)

    def __call__(self, observation: Observation) -> str | None:
        """Return why the run is over, or None."""
        self.seen = [observation]
        self.touch.update()
        if self.look is not None:
            self.look(observation, self.controller)
        if self.landings is not None:
            self.landings.update(observation)
        if self.touch.touched and not self.to_the_end:
            return "fell"
        base = observation.base
        moving = base is None or float(np.linalg.norm(base.linear_velocity)) > STILL
        if moving:
            self.still = nan
        elif np.isnan(self.still):
            self.still = observation.time
        over = observation.time - self.plan.end
        busy = isinstance(self.controller, Stepper) and self.controller.phase != "stand"
        if over >= AFTER and (not (busy or moving) or over >= AFTER + LONGEST):
            return "done" if not moving else "does not come to rest"
        return None


def push_robot(
    robot: Robot, plan: PushPlan, *, to_the_end: bool = False, look: Look | None = None
) -> dict[str, Any]:
    """Let a fresh twin stand, push it, and return how it went.

    Args:
        robot: The robot.
        plan: What is done to it.
        to_the_end: Do not stop at the first touch of anything but a foot: fall until it lies.
        look: Called at every tick until then, with the observation and the controller.

    Raises:
        UsageError: A body or a height that the robot does not have, or it cannot step.
        WindupError: From the loop.
    """
    description = robot.description
    stance = stepping_stance(description, plan.stance)
    regions = forbidden(plan.forbid)
    delay = robot.stack.delay
    controller = build_stepper(description, plan.way, stance, regions, plan.support, delay)
    robot.start_in(stance)
    arrange(robot, plan)
    touch = TouchWatch(description, robot.twin.model, robot.twin.data)
    landings = Landings(robot, footing_of(description, stance), regions) if regions else None
    watch = PushWatch(plan, touch, controller, to_the_end, look, landings)
    stepper = controller if isinstance(controller, Stepper) else None
    report = robot.run(controller, until=watch, needs_imu=stepper is not None)
    survived = report.reason == "done" and not (robot.fallen or touch.touched)
    if to_the_end and robot.fallen and not robot.protect:
        robot.run(PoseHolder(robot.description.joints, stance, ramp=0.0), LANDING, down=True)
    more = {} if landings is None else landings.record()
    return more | {
        "robot": description.name,
        "way": plan.way,
        "impulse": plan.impulse,
        "directions": list(plan.directions),
        "seed": robot.seed,
        "survived": survived,
        "reason": "fell" if touch.touched else report.reason,
        "touched": watch.touch.touched,
        "steps": stepper.steps if stepper else 0,
        "comfort_steps": stepper.comforts if stepper else 0,
        "settling_s": max(watch.still - plan.end, 0.0) if survived else None,
        "astray_m": astray(robot, stance, watch.seen[-1]) if survived else None,
        "tick_ms": report.tick_ms(),
    }


def arrange(robot: Robot, plan: PushPlan) -> None:
    """Let the pushes of `plan` come, counted from now.

    Raises:
        UnknownNameError: The robot has no such body.
        UsageError: The height is not on the robot.
    """
    twin, body = robot.twin, plan.body or robot.description.torso
    twin.check_body(body)
    height = None
    if plan.height is not None:
        tallest = float((twin.data.geom_xpos[:, 2] + twin.model.geom_rbound).max())
        if not 0.0 < plan.height < tallest:
            raise UsageError(f"--height {plan.height:g}: give 0 .. {tallest:.2f} m above the floor")
        height = plan.height - float(twin.data.body(body).xpos[2])
    for number, direction in enumerate(plan.directions):
        start = twin.time + plan.at + number * plan.every
        push = Push.impulse(body, plan.impulse, radians(direction), start, plan.duration, height)
        twin.push(push)


def astray(robot: Robot, stance: Array, seen: Observation) -> float:
    """Return how far the feet stand from where the stance has them beside each other, m."""
    footing = footing_of(robot.description, stance)
    footing.update(seen)
    home = footing.homes[0][:2] - footing.homes[1][:2]
    way = turn(footing.planted().front)[:2, :2].T @ (footing.places[0] - footing.places[1])
    return float(np.linalg.norm(way - home))
