"""Interfaces of controllers, of batch policies, and of the predictor that plays rollouts."""

from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

from windup.hal.command import JointCommand
from windup.hal.joints import Array, Mask
from windup.hal.observation import Observation

Plane = tuple[float, float, float]


class Controller(Protocol):
    """Computes joint commands from observations.

    A controller does no I/O and reads no clock: the same observations (and predictions) give
    bit-identical commands.
    """

    def reset(self, observation: Observation) -> None:
        """Initialise the controller with `observation`.

        Raises:
            StateMissingError: The observation lacks a quantity that the controller needs.
        """
        ...

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command for the tick that starts now and lasts `dt` s."""
        ...


@runtime_checkable
class HasFirstPose(Protocol):
    """A controller that moves to its first pose gradually: its first command is not that pose."""

    @property
    def first_pose(self) -> Array:
        """(n,) pose that the controller moves to first, rad."""
        ...


def first_pose_of(controller: Controller, first: JointCommand) -> Array:
    """Return the pose (n,) rad that a controller moves to first; `first` is its first command."""
    return controller.first_pose if isinstance(controller, HasFirstPose) else first.position


@dataclass(frozen=True, slots=True)
class Outcomes:
    """Final states of m rollouts, each at the instant its policy was done or the robot fell.

    World frame, m and m/s; quaternions wxyz.

    Attributes:
        duration: (m,) simulated time until then, s.
        base_position: (m, 3).
        base_orientation: (m, 4).
        base_velocity: (m, 6) linear in the world frame, angular in the body frame.
        joint_position: (m, n) rad.
        com: (m, 3) whole-body centre of mass.
        com_velocity: (m, 3).
        feet: (m, feet, 3) centres of the soles.
        torso: (m, 3) unit vector along the torso.
        contacts: (m, k) normal forces of the contact sensors, N.
        fell: (m,) bool, whether the robot fell.
    """

    duration: Array
    base_position: Array
    base_orientation: Array
    base_velocity: Array
    joint_position: Array
    com: Array
    com_velocity: Array
    feet: Array
    torso: Array
    contacts: Array
    fell: Mask


@dataclass(slots=True)
class PolicyInput:
    """Present state of m rollouts, passed to a batch policy each tick; rows are rollouts.

    Attributes:
        joint_position: (m, n) rad.
        joint_velocity: (m, n) rad/s.
        base_orientation: (m, 4) wxyz.
        base_angular_velocity: (m, 3) rad/s in the body frame.
        contacts: (m, k) normal forces of the contact sensors, N.
    """

    joint_position: Array
    joint_velocity: Array
    base_orientation: Array
    base_angular_velocity: Array
    contacts: Array


class BatchPolicy(Protocol):
    """A controller of m simulated robots at once."""

    @property
    def size(self) -> int:
        """Number m of rollouts."""
        ...

    @property
    def done(self) -> Mask:
        """(m,) bool: rollouts that are finished."""
        ...

    def step(self, state: PolicyInput, dt: float) -> Array:
        """Return target positions (m, n) rad for the tick that starts now."""
        ...


@dataclass(frozen=True, slots=True)
class RolloutStart:
    """Initial state of a prediction.

    Attributes:
        observation: The state, including that of the base.
        in_flight: (d, n) target positions that were sent but have not yet taken effect because of
            the latency, oldest first, one per tick, rad.
        dt: Period of a tick, s.
        ground: Estimated ground plane: height at the origin, m; slope along x; slope along y.
    """

    observation: Observation
    in_flight: Array
    dt: float
    ground: Plane | None = None


class Predictor(Protocol):
    """Simulates a batch policy from an observed state over a horizon."""

    @property
    def stopwatch(self) -> "Stopwatch":
        """Number of rollouts so far and the wall time they took."""
        ...

    def predict(self, start: RolloutStart, policy: BatchPolicy, horizon: float) -> Outcomes:
        """Return the final states of `policy.size` rollouts of at most `horizon` s."""
        ...


@dataclass(slots=True)
class Stopwatch:
    """Count and wall time of a repeated operation.

    Attributes:
        count: Number of items processed.
        seconds: Total wall time, s.
        laps: Wall time of each call, s.
    """

    count: int = 0
    seconds: float = 0.0
    laps: list[float] = field(default_factory=list)

    def add(self, count: int, seconds: float) -> None:
        """Record one call that processed `count` items in `seconds`."""
        self.count += count
        self.seconds += seconds
        self.laps.append(seconds)
