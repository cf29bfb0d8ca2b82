"""Interfaces of executors: what they measure for the decisions on steps, and what they realise.

An executor belongs to one kind of joints. `ServoExecutor` and `LegExecutor` compute joint angles
for position servos; `TorqueExecutor` computes torques.
"""

from collections.abc import Sequence
from typing import Protocol, TypeVar

from windup.control.execution.motion import Motion, Planted, WalkMotion
from windup.control.kinematics.limb_ik import Pose
from windup.control.kinematics.momenta import Momenta
from windup.control.kinematics.robot_state import RobotState
from windup.control.kinematics.support import SupportRegion
from windup.hal.command import JointCommand
from windup.hal.joints import Array
from windup.hal.observation import Observation

M_contra = TypeVar("M_contra", bound=Motion, contravariant=True)


class Feet(Protocol):
    """The two feet of a robot, as measured in this tick.

    Attributes:
        rounded: Support regions are circles and capsules instead of hulls.
    """

    rounded: bool

    @property
    def homes(self) -> Sequence[Array]:
        """Positions (3,) of the soles' centres in the stance, in one level frame, m."""
        ...

    @property
    def momenta(self) -> Momenta:
        """Momenta of the whole body."""
        ...

    @property
    def yaw(self) -> float:
        """Heading of the base, rad."""
        ...

    @property
    def feet(self) -> Sequence[Pose]:
        """Poses of the soles' sites."""
        ...

    @property
    def places(self) -> Array:
        """(2, 2) horizontal positions of these sites, m."""
        ...

    @property
    def down(self) -> Sequence[bool]:
        """For each foot, whether it is on the ground, by its height."""
        ...

    def reach_yaw(self, stance: int) -> float:
        """Return the heading, rad, of the other foot's reach beside the stance foot."""
        ...

    def ground(self, foot: int) -> Array:
        """Return the points (p, 3) of a sole in the world frame, m."""
        ...

    def middle(self, foot: int) -> Array:
        """Return the middle (2,) of a sole on the ground, m."""
        ...

    def support(self, feet: Sequence[int]) -> SupportRegion:
        """Return the support region of these feet's soles, whether or not they bear load."""
        ...

    def planted(self) -> Planted:
        """Return the measured places of the feet."""
        ...


class Executor(Protocol[M_contra]):
    """Realises a motion with the joints of one robot."""

    @property
    def state(self) -> RobotState:
        """The robot's state."""
        ...

    def reset(self, observation: Observation) -> None:
        """Start in the stance; integrators and filters are cleared.

        Raises:
            StateMissingError: The observation has no base.
        """
        ...

    def observe(self, observation: Observation) -> None:
        """Measure the robot; once a tick, before all else.

        Raises:
            StateMissingError: The observation has no base.
        """
        ...

    def due(self, now: float, dt: float) -> bool:
        """Return whether the motion may be changed in this tick; call it once a tick."""
        ...

    def realise(self, motion: M_contra, now: float, dt: float) -> JointCommand:
        """Return the command of this tick.

        Raises:
            WindupError: The optimisation of whole-body control found no solution.
        """
        ...

    def touches(self, foot: int) -> bool:
        """Return whether a foot whose swing is over has come down, by sensors where it has them."""
        ...


class StepExecutor(Executor[Motion], Protocol):
    """Executor of steps that prevent a fall.

    The weight whose path a motion has is the centre of mass with torques. With position servos it
    is the base, which the legs move by as much.
    """

    @property
    def feet(self) -> Feet:
        """The feet, as measured."""
        ...

    @property
    def weight(self) -> Array:
        """(2,) measured position of the weight, m."""
        ...

    def ease(self, part: float) -> float:
        """Return the fraction of a shift of the weight done at a fraction of the time."""
        ...

    def take(self, observation: Observation) -> None:
        """Start from any state; the robot comes to its stance gradually."""
        ...

    def over(self, foot: int) -> Array:
        """Return the position (2,) of the weight over one foot, m."""
        ...

    def home(self, planted: Planted) -> Array:
        """Return the position (2,) of the weight in the stance, for feet at these places, m."""
        ...

    def anchor(self, motion: Motion, now: float) -> Array:
        """Return the position (2,) of the weight where a swing may start now, m."""
        ...

    def lift_off(self, foot: int, planted: Planted) -> Array:
        """Return the position (3,) of a sole from which its swing starts, m."""
        ...


class WalkExecutor(Executor[WalkMotion], Protocol):
    """Executor of slow steps to footprints; their weight is the centre of mass."""

    @property
    def follows_feet(self) -> bool:
        """The weight is shifted from where it is measured to a goal that follows the feet."""
        ...

    @property
    def places(self) -> Array:
        """(2, 3) measured places of the feet: x m, y m, yaw rad."""
        ...

    @property
    def com(self) -> Array:
        """(2,) measured position of the centre of mass, m."""
        ...

    @property
    def com_velocity(self) -> Array:
        """(2,) measured velocity of the centre of mass, m/s."""
        ...

    @property
    def yaw(self) -> float:
        """Measured heading of the base, rad."""
        ...

    @property
    def height(self) -> float:
        """Measured height of the base above the ground, m."""
        ...

    def middle(self, foot: int) -> Array:
        """Return the middle (2,) of a sole on the ground, m."""
        ...

    def lift_off(self, foot: int, planted: Planted) -> Array:
        """Return the position (3,) of a sole from which its swing starts, m."""
        ...
