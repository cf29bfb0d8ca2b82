"""Protection settings of servos: the owner's choice, but reported if they are unusual.

Current Limit and Velocity Limit of a Dynamixel X are not included: they limit a goal current and
a profile velocity (e-Manual, 38 and 44), which position mode without a profile does not use.
"""

from typing import NamedTuple

from windup.hal.servos.servo_model import ServoModel


class FactoryDefault(NamedTuple):
    """Factory default of a protection register.

    Attributes:
        name: The register.
        value: Its factory default, counts.
        lower: Whether a lower value is reported.
        higher: Whether a higher value is reported.
    """

    name: str
    value: int
    lower: bool = True
    higher: bool = False

    def is_unusual(self, present: int) -> bool:
        """Return whether a value differs from the default in a way that is reported."""
        return (self.lower and present < self.value) or (self.higher and present > self.value)


def protective_limits(model: ServoModel) -> tuple[FactoryDefault, ...]:
    """Return the factory default limits of a model; empty if they are not published.

    With a lower temperature limit the servo shuts down early, with a higher one too late. With a
    narrower supply range it signals errors, and shuts down if its shutdown mask includes them.
    """
    if model.limits is None:
        return ()
    heat, low, high = model.limits
    return (
        FactoryDefault("temperature_limit", round(heat), higher=True),
        FactoryDefault("min_voltage_limit", round(10.0 * low), lower=False, higher=True),
        FactoryDefault("max_voltage_limit", round(10.0 * high)),
    )
