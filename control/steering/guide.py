"""What a walker is told to do, and who tells it: once a step, from where it is."""

from dataclasses import dataclass
from typing import Protocol

from windup.hal.joints import Array


@dataclass(frozen=True)
class Place:
    """Where a robot is on the ground.

    Attributes:
        position: (2,) m.
        heading: rad.
        speed: Forward speed that it is walking at, m/s.
    """

    position: Array
    heading: float
    speed: float


@dataclass(frozen=True)
class WalkCommand:
    """How to walk; left is positive.

    Attributes:
        speed: m/s, or None for what was said before.
        side: Sideways speed, m/s.
        turn: Turn rate, rad/s; with a `direction` it is the fastest.
        direction: Heading to turn to, rad, or None to turn for ever.
        stop: Walk no farther: come to rest.
    """

    speed: float | None = None
    side: float = 0.0
    turn: float = 0.0
    direction: float | None = None
    stop: bool = False


class Guide(Protocol):
    """Tells a walker what to do."""

    def command(self, place: Place) -> WalkCommand:
        """Return what to do in the step that begins at `place`."""
        ...


@dataclass
class Steady:
    """A guide that always says the same, until somebody changes its mind.

    Attributes:
        order: What it says.
    """

    order: WalkCommand = WalkCommand()

    def command(self, place: Place) -> WalkCommand:
        """Return the order."""
        return self.order
