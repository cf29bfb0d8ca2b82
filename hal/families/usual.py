"""Settings that say when a servo protects itself: its owner's to choose, and shown where odd.

Not among them are Current Limit and Velocity Limit of a Dynamixel X: they bound a goal current and
a profile velocity (e-Manual, 38 and 44), and in position mode without a profile there is neither.
"""

from typing import NamedTuple

from windup.hal.servos.servo_model import ServoModel


class Usual(NamedTuple):
    """What a register holds as its maker delivers the servo.

    Attributes:
        name: The register.
        value: Its counts.
        lower: Is a lower value worth a word?
        higher: Is a higher one?
    """

    name: str
    value: int
    lower: bool = True
    higher: bool = False

    def is_odd(self, present: int) -> bool:
        """Return whether a value is worth a word."""
        return (self.lower and present < self.value) or (self.higher and present > self.value)


def protective_limits(model: ServoModel) -> tuple[Usual, ...]:
    """Return where a model gives up, as it is delivered; nothing where that is not published.

    Below its temperature limit it shuts down early, above it too late. A narrower range of supply
    has it signal errors, and shut down where its mask says so.
    """
    if model.limits is None:
        return ()
    heat, low, high = model.limits
    return (
        Usual("temperature_limit", round(heat), higher=True),
        Usual("min_voltage_limit", round(10.0 * low), lower=False, higher=True),
        Usual("max_voltage_limit", round(10.0 * high)),
    )
