"""Warning and stop levels of the joints' health, as given in the `[safety]` table."""

from collections.abc import Iterator
from typing import Annotated

from msgspec import Meta

from windup.hal.config import TomlRecord
from windup.hal.guard import HealthKind

Amount = Annotated[float, Meta(gt=0.0, le=1000.0)]


class Level(TomlRecord, frozen=True):
    """A warning level, and a stop level at which the robot is stopped."""

    warn: Amount
    stop: Amount


class JointLevels(TomlRecord, frozen=True):
    """Warning and stop levels of the joints; omitted ones follow from their servos.

    Attributes:
        supply_low: Minimum supply voltage, V; for a battery.
        supply_high: Maximum supply voltage, V.
        temperature: Maximum temperature of a servo, degrees C.
        load: Maximum mean torque over about a second, as a share of the stall torque.
        stall: Maximum time that a joint pushes at its torque limit without moving, s.
    """

    supply_low: Level | None = None
    supply_high: Level | None = None
    temperature: Level | None = None
    load: Level | None = None
    stall: Level | None = None

    def configured(self) -> dict[HealthKind, tuple[float, float]]:
        """Return the warning and stop levels that are given, by kind."""
        levels = {kind: getattr(self, kind.name.lower()) for kind in HealthKind}
        return {kind: (level.warn, level.stop) for kind, level in levels.items() if level}

    def mistakes(self, supply: float) -> Iterator[tuple[str, str]]:
        """Yield key and message of each mistake, for a robot with a supply of `supply` V."""
        for kind, (warn, stop) in self.configured().items():
            key, low = kind.name.lower(), kind is HealthKind.SUPPLY_LOW
            if warn < stop if low else warn > stop:
                yield key, f"the warning at {warn:g} would come after the stop at {stop:g}"
            if kind in (HealthKind.SUPPLY_LOW, HealthKind.SUPPLY_HIGH) and (
                low == (warn >= supply)
            ):
                side = "below" if low else "above"
                yield key, f"the warning at {warn:g} V is not {side} drive.supply, {supply:g} V"
