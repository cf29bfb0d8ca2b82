"""What comes before the first command to an armed robot: how it is, and its first motion."""

from collections.abc import Sequence
from functools import partial
from math import degrees

import numpy as np

from windup.control.estimation.posture import Posture, PostureSense
from windup.control.kinematics.legs import legs_of
from windup.control.motions.first_motion import Approach, FirstMotion
from windup.control.motions.planted import Planted
from windup.hal.command import FIELDS
from windup.hal.controller import Controller
from windup.hal.errors import PostureError
from windup.hal.guard.guarded import GuardedBackend
from windup.hal.joints import Mask
from windup.hal.observation import Observation
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.robots import RobotDescription
from windup.tools.assembly.protect import leg_joints, spread
from windup.tools.robot.stack import Stack

LOOK = 0.3
"""How long the accelerometer is averaged, s."""
PERIOD = 0.01
"""Between two looks, s."""
STILL = 0.5
"""A robot that turns no faster than this is at rest, or in somebody's hands, rad/s."""
PATIENCE = 5.0
"""How long one that moves is waited for, s: limp, it may just be falling."""
OUTSIDE = 0.12
"""A joint that is farther outside of its limits would jump, rad; their stops are not exact."""
CLEAR = 0.02
"""A robot of which something else is no higher than this above its feet rests on that too, m; where
that is so in its stance, because its ankles are low, half as high as there."""


class Start:
    """The start of one robot on a port of servos.

    Args:
        robot: The robot.
        stack: Its stack.

    Attributes:
        motion: Its first motion.
        unseen: Torque has come on since somebody looked how it is.
    """

    def __init__(self, robot: RobotDescription, stack: Stack) -> None:
        self.robot, self.stack, self.backend = robot, stack, stack.backend
        model, safety = robot.model, robot.safety
        share = spread(safety.first_stiffness, leg_joints(robot, model))
        feet = [foot.body for foot in robot.feet]
        known = not (robot.fixed or robot.passive)
        legs = None
        if known:
            legs = legs_of(model, robot.base, feet, robot.joints, robot.stance)
        planted = None if legs is None else Planted(robot.joints, legs)
        clipped = partial(_note_clipped, self.backend)  # not a method: no cycle of references
        self.motion = FirstMotion(
            robot.joints, share, safety.first_speed, safety.first_lag, planted, clipped
        )
        self._sense, self._clear = None, CLEAR
        if robot.imu is not None and robot.feet and known:
            self._sense = PostureSense(model, feet)
            low, others = self._sense.lowest(robot.stance, np.array([0.0, 0.0, 1.0]))
            self._clear = min(CLEAR, 0.5 * (others - low))
        self.unseen = True
        if isinstance(self.backend.backend, ServoBackend):
            self.backend.backend.arming_stiffness = share * robot.joints.stiffness

    def begin(self) -> None:
        """Torque has come on."""
        self.motion.begin()
        self.unseen = True

    def before(self, controller: Controller, down: bool) -> Approach:
        """Return `controller` with the first motion before it; the robot may lie if `down`."""
        return self.motion.before(controller, upright=not down)

    def check(self, down: bool) -> None:
        """Look at a robot before it moves.

        Args:
            down: What it shall do needs no feet.

        Raises:
            PostureError: A joint stands outside of its limits, or the robot sits or lies.
        """
        self._check_limits()
        if not down:
            self._check_upright()

    def _check_limits(self) -> None:
        """Raise if a goal inside a joint's limits would be a jump."""
        joints, state = self.robot.joints, self.backend.peek().joints
        outside = np.maximum(joints.lower - state.position, state.position - joints.upper)
        worst = int(np.where(state.age < LOOK, outside, 0.0).argmax())
        if outside[worst] > OUTSIDE and state.age[worst] < LOOK:
            here, low, high = (
                degrees(values[worst]) for values in (state.position, joints.lower, joints.upper)
            )
            raise PostureError(
                f"{joints.names[worst]} reads {here:.0f} degrees, outside of its limits "
                f"({low:.0f} .. {high:.0f}): turn it back by hand, or correct its sign, id or zero "
                "in robot.toml"
            )

    def _check_upright(self) -> None:
        posture, fall = self._look(), self.robot.fall
        if posture is None:
            return
        if posture.tilt > fall.tilt:
            how = f"lies on its {posture.side}"
        elif posture.height < fall.height or posture.clearance < self._clear:
            how = "sits"
        else:
            return
        raise PostureError(f"{self.robot.name} {how}: put it on its feet{self._or_rise()}")

    def _look(self) -> Posture | None:
        """Return how the robot is once it is at rest, or None where that cannot be told.

        Raises:
            PostureError: It does not come to rest.
        """
        if self._sense is None:
            return None
        until = self.backend.clock.now() + PATIENCE
        while _fastest(seen := self._look_on()) > STILL:
            if self.backend.clock.now() > until:
                raise PostureError(f"{self.robot.name} is moving: hold it still until it stands")
        if seen[-1].joints.age.max() > LOOK:
            return None  # arming will say which servo is silent
        return self._sense.posture(seen)

    def _look_on(self) -> list[Observation]:
        """Return what is seen within a while."""
        seen: list[Observation] = []
        clock = self.backend.clock
        for _ in range(round(LOOK / PERIOD)):
            self.backend.heartbeat()
            seen.append(self.backend.peek())
            if self.stack.estimator is not None and seen[-1].imu is not None:
                # Once torque comes on, an accelerometer feels more than gravity.
                self.stack.estimator.update(seen[-1], PERIOD)
            clock.wait_until(clock.now() + PERIOD)
        return seen

    def _or_rise(self) -> str:
        """Return what else a person can do, for those robots that get up by themselves."""
        if "get_up_front" not in self.robot.gaits():
            return ""
        arm = " --arm" if self.stack.real else ""
        return f", or run `windup rise {self.robot.name} --port {self.stack.port}{arm}`"


def _fastest(seen: Sequence[Observation]) -> float:
    """Return the fastest turn that an IMU felt, rad/s; 0 without any."""
    turns = [item.imu.angular_velocity for item in seen if item.imu is not None]
    return float(np.linalg.norm(turns, axis=1).max()) if turns else 0.0


def _note_clipped(backend: GuardedBackend, beyond: Mask) -> None:
    """Count the joints (n,) bool of a first pose that was clipped, as the guard does."""
    changed = np.zeros((len(FIELDS), len(beyond)), dtype=bool)
    changed[FIELDS.index("position")] = beyond
    backend.note_clamps(changed)
