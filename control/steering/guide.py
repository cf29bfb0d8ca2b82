"""Walk commands and their sources (guides), which are asked once per step."""

from dataclasses import dataclass
from typing import Protocol

from windup.hal.joints import Array


@dataclass(frozen=True)
class Place:
    """Position, heading and speed of a robot on the ground.

    Attributes:
        position: (2,) m.
        heading: Heading, rad.
        speed: Present forward speed, m/s.
    """

    position: Array
    heading: float
    speed: float


@dataclass(frozen=True)
class WalkCommand:
    """Command to a walking robot; left is positive.

    Attributes:
        speed: Forward speed, m/s, or None to keep the last commanded one.
        side: Sideways speed, m/s.
        turn: Turn rate, rad/s; with a `direction` it is the maximum turn rate.
        direction: Heading to turn to, rad, or None to turn without end.
        stop: Come to rest.
    """

    speed: float | None = None
    side: float = 0.0
    turn: float = 0.0
    direction: float | None = None
    stop: bool = False


class Guide(Protocol):
    """Source of walk commands."""

    def command(self, place: Place) -> WalkCommand:
        """Return the command for the step that begins at `place`."""
        ...


@dataclass
class Steady:
    """A guide that returns a constant command, until `order` is assigned.

    Attributes:
        order: The command.
    """

    order: WalkCommand = WalkCommand()

    def command(self, place: Place) -> WalkCommand:
        """Return `order`."""
        return self.order
