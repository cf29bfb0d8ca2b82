"""Pose control graphs: desired poses, the transitions between them, and their algebra.

Laszlo 1996, section 2.3. Each state of a graph has a desired pose and a transition: after a hold
time, or when a foot or a single sensor touches the ground (or a time-out has passed). A *relative*
graph has the same shape and holds differences, so that a controlled graph is

    C = B + k dP                                                           (section 2.3.1)

for a base graph B, a perturbation dP and a scaling k. Sensor transitions are not perturbed.
"""

from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from windup.hal.errors import ConfigError, UnknownNameError
from windup.hal.joints import Array, Mask

FOREVER = np.inf


@dataclass(frozen=True)
class RelativeGraph:
    """A change to a pose graph of s states and n joints.

    Attributes:
        pose: (s, n) change of the desired positions, rad.
        hold: (s,) change of the hold times, s.
    """

    pose: Array
    hold: Array

    def __add__(self, other: "RelativeGraph") -> "RelativeGraph":
        return RelativeGraph(self.pose + other.pose, self.hold + other.hold)

    def __mul__(self, scale: float) -> "RelativeGraph":
        return RelativeGraph(scale * self.pose, scale * self.hold)

    __rmul__ = __mul__


@dataclass(frozen=True)
class PoseGraph:
    """A pose control graph of s states over n joints and k contact sensors.

    Attributes:
        names: The s state names.
        pose: (s, n) desired positions, rad.
        hold: (s,) time in the state before a timed transition, s; infinite for a sensor transition.
        sensors: (s, k) bool, sensors of which any one ends the state; none for a timed transition.
        timeout: (s,) time-out of a sensor transition, s; may be infinite.
        successor: (s,) index of the next state; the last state of an aperiodic graph has its own.
        stance: (s,) index of the stance foot of the step that the state belongs to, or -1.
        ends_step: (s,) bool, True if the end of the state is the end of a step.
        origin: Path of the gait file, for error messages.
    """

    names: tuple[str, ...]
    pose: Array
    hold: Array
    sensors: Mask
    timeout: Array
    successor: npt.NDArray[np.intp]
    stance: npt.NDArray[np.intp]
    ends_step: Mask
    origin: str = field(default="graph", compare=False)

    def __post_init__(self) -> None:
        reached = {0}
        state = 0
        while (state := int(self.successor[state])) not in reached:
            reached.add(state)
        if missing := sorted(set(range(len(self.names))) - reached):
            lost = ", ".join(self.names[state] for state in missing)
            raise ConfigError(
                f"{self.origin}: no state leads to {lost}; "
                "give the state before it a `next`, or delete it"
            )

    def __len__(self) -> int:
        return len(self.names)

    @property
    def periodic(self) -> bool:
        """True if the graph cycles for ever; False if it ends in a last state."""
        state, seen = 0, set[int]()
        while state not in seen:
            seen.add(state)
            state = int(self.successor[state])
        return int(self.successor[state]) != state

    def index(self, name: str) -> int:
        """Return the index of state `name`.

        Raises:
            UnknownNameError: There is no such state.
        """
        if name not in self.names:
            raise UnknownNameError("state", name, self.names)
        return self.names.index(name)

    def __add__(self, change: RelativeGraph) -> "PoseGraph":
        if change.pose.shape != self.pose.shape:
            raise ConfigError(
                f"{self.origin}: a perturbation of {len(change.pose)} states "
                f"on a graph of {len(self)}; both need the same states"
            )
        return replace(self, pose=self.pose + change.pose, hold=self.hold + change.hold)

    def __sub__(self, other: "PoseGraph") -> RelativeGraph:
        self._same_shape(other)
        timed = np.isfinite(self.hold) & np.isfinite(other.hold)
        hold = np.where(timed, self.hold, 0.0) - np.where(timed, other.hold, 0.0)
        return RelativeGraph(self.pose - other.pose, hold)

    def blend(self, other: "PoseGraph", amount: float) -> "PoseGraph":
        """Return the interpolation of this graph (`amount` 0) and `other` (1), section 5.4."""
        return self + amount * (other - self)

    def _same_shape(self, other: "PoseGraph") -> None:
        """Raise unless the states of both have the same transitions, sensors and stance feet.

        Raises:
            ConfigError: They differ.
        """
        same = len(self) == len(other) and all(
            np.array_equal(one, two)
            for one, two in (
                (self.successor, other.successor),
                (self.sensors, other.sensors),
                (self.stance, other.stance),
                (self.ends_step, other.ends_step),
            )
        )
        if not same:
            raise ConfigError(
                f"{self.origin} and {other.origin} have different states "
                f"({', '.join(self.names)} and {', '.join(other.names)}) and cannot be blended; "
                "give both as many, with the same `until`, `stance` and `ends_step`"
            )
