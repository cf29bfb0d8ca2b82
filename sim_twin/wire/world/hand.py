"""A simulated hand that turns limp shafts, as a user does to show a client their range."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, NamedTuple

from windup.hal.errors import UsageError
from windup.hal.ranges import Range, read_number
from windup.sim_twin.wire.device import Device

DEGREES: Final = Range(-360.0, 360.0, "degrees")
SECONDS: Final = Range(0.01, 3600.0, "s")
EXAMPLE: Final = "'r_knee:20:3s,l_knee:-20:3s'"


class HandMotion(NamedTuple):
    """The motion of a hand.

    Attributes:
        joint: The joint; on a bench, the id of the servo.
        angle: Largest displacement from the initial angle, rad.
        seconds: Duration of the motion there, s; the motion back takes as long.
    """

    joint: str
    angle: float
    seconds: float


class JointGrip(NamedTuple):
    """Access of a hand to one joint.

    Attributes:
        device: Servo of the joint.
        angle: Returns the angle of the joint, rad.
        turn: Sets the joint to an angle, rad, and a rate, rad/s.
    """

    device: Device
    angle: Callable[[], float]
    turn: Callable[[float, float], None]


def parse_hands(text: str) -> list[HandMotion]:
    """Return the motions of a text ``JOINT:DEGREES:SECONDS``, several joined by commas.

    >>> parse_hands("r_knee:180:3s")
    [HandMotion(joint='r_knee', angle=3.141592653589793, seconds=3.0)]

    Raises:
        UsageError: The text is malformed or a number is out of range.
    """
    return [_parse(part.strip()) for part in text.split(",") if part.strip()]


def _parse(part: str) -> HandMotion:
    joint, *numbers = (word.strip() for word in part.split(":"))
    if not joint or len(numbers) != 2:
        raise UsageError(f"hand: {part!r}: a joint, degrees and seconds, as in {EXAMPLE}")
    angle = read_number(f"hand: {part!r}: degrees", numbers[0], DEGREES)
    seconds = read_number(f"hand: {part!r}: seconds", numbers[1].removesuffix("s"), SECONDS)
    return HandMotion(joint, math.radians(angle), seconds)


@dataclass
class Hand:
    """Turns one joint to and fro, smoothly, while its servo does not drive it.

    After the servo has driven the joint, the hand starts again from the joint's new angle.

    Attributes:
        grip: Access to the joint.
        motion: The motion.
    """

    grip: JointGrip
    motion: HandMotion
    _start: float = 0.0
    _time: float | None = None  # time since it began to turn the joint, s; None while driven

    def move(self, dt: float) -> None:
        """Continue the motion by `dt` s."""
        grip, (_, angle, seconds) = self.grip, self.motion
        if grip.device.driving:
            self._time = None
            return
        if self._time is None:
            self._start, self._time = grip.angle(), 0.0
        self._time += dt
        rate = math.pi / seconds
        phase = rate * self._time
        half = 0.5 * angle
        grip.turn(self._start + half * (1.0 - math.cos(phase)), half * rate * math.sin(phase))
