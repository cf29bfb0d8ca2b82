"""What a controller is, and what it may ask of a predictor."""

from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

from windup.hal.command import JointCommand
from windup.hal.joints import Array, Mask
from windup.hal.observation import Observation

Plane = tuple[float, float, float]


class Controller(Protocol):
    """Observations in, joint commands out.

    No input or output and no clock of its own: the same observations (and predictions) give the
    same bytes.
    """

    def reset(self, observation: Observation) -> None:
        """Start from `observation`.

        Raises:
            StateMissingError: The controller needs a state that the observation lacks.
        """
        ...

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command for the tick that begins now and lasts `dt` s."""
        ...


@runtime_checkable
class Begins(Protocol):
    """A controller whose first command is only the beginning of a way to its first pose."""

    @property
    def first_pose(self) -> Array:
        """(n,) rad where it goes first."""
        ...


def first_pose_of(controller: Controller, first: JointCommand) -> Array:
    """Return where a controller goes first, (n,) rad; `first` is its first command."""
    return controller.first_pose if isinstance(controller, Begins) else first.position


@dataclass(frozen=True, slots=True)
class Outcomes:
    """States of m rollouts, each at the instant its policy called itself done (or fell).

    World frame, m and m/s; quaternions wxyz.

    Attributes:
        duration: (m,) simulated time, s.
        base_position: (m, 3).
        base_orientation: (m, 4).
        base_velocity: (m, 6) linear in the world, angular in the body.
        joint_position: (m, n) rad.
        com: (m, 3) whole-body centre of mass.
        com_velocity: (m, 3).
        feet: (m, feet, 3) centres of the soles.
        torso: (m, 3) unit vector along the torso.
        contacts: (m, k) N.
        fell: (m,) bool.
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
    """The live state of m rollouts, as a batch policy sees it each tick; rows are rollouts.

    Attributes:
        joint_position: (m, n) rad.
        joint_velocity: (m, n) rad/s.
        base_orientation: (m, 4) wxyz.
        base_angular_velocity: (m, 3) rad/s in the body.
        contacts: (m, k) N.
    """

    joint_position: Array
    joint_velocity: Array
    base_orientation: Array
    base_angular_velocity: Array
    contacts: Array


class BatchPolicy(Protocol):
    """A controller for m robots at once."""

    @property
    def size(self) -> int:
        """The number m of rollouts wanted."""
        ...

    @property
    def done(self) -> Mask:
        """(m,) bool: rollouts that have reached their end."""
        ...

    def step(self, state: PolicyInput, dt: float) -> Array:
        """Return target positions (m, n) rad for the tick that begins now."""
        ...


@dataclass(frozen=True, slots=True)
class RolloutStart:
    """Where a prediction begins.

    Attributes:
        observation: The state, with its base.
        in_flight: (d, n) target positions sent before and not yet at the joints, oldest first,
            one a tick, rad.
        dt: Period of a tick, s.
        ground: Ground as it was felt: height at the origin, m; rise along x; along y.
    """

    observation: Observation
    in_flight: Array
    dt: float
    ground: Plane | None = None


class Predictor(Protocol):
    """Plays a batch policy forward from a state that was observed."""

    @property
    def stopwatch(self) -> "Stopwatch":
        """Rollouts played so far and the time they took."""
        ...

    def predict(self, start: RolloutStart, policy: BatchPolicy, horizon: float) -> Outcomes:
        """Return the outcomes of `policy.size` rollouts of at most `horizon` s."""
        ...


@dataclass(slots=True)
class Stopwatch:
    """Count and wall time of something done now and then.

    Attributes:
        count: How many.
        seconds: Wall time spent.
        laps: Wall time of each call, s.
    """

    count: int = 0
    seconds: float = 0.0
    laps: list[float] = field(default_factory=list)

    def add(self, count: int, seconds: float) -> None:
        """Count one call that did `count` things in `seconds`."""
        self.count += count
        self.seconds += seconds
        self.laps.append(seconds)
