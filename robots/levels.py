"""`[safety]`: the levels at which a joint is unwell, and how they go with its servo's own."""

from collections.abc import Iterator
from typing import Annotated

from msgspec import Meta

from windup.hal.config import Record
from windup.hal.guard import Kind

Amount = Annotated[float, Meta(gt=0.0, le=1000.0)]


class Level(Record, frozen=True):
    """A value from which on a warning is due, and one from which on the robot is stopped."""

    warn: Amount
    stop: Amount


class JointLevels(Record, frozen=True):
    """When the joints of a robot are unwell; what is left out follows from their servos.

    Attributes:
        supply_low: Supply below which a warning, and a stop, is due, V; for a battery.
        supply_high: Supply above which they are due, V.
        temperature: Of a servo, degrees C.
        load: Mean torque over about a second, as a share of that at stall.
        stall: How long a joint pushes at its limit without moving, s.
    """

    supply_low: Level | None = None
    supply_high: Level | None = None
    temperature: Level | None = None
    load: Level | None = None
    stall: Level | None = None

    def given(self) -> dict[Kind, tuple[float, float]]:
        """Return warning and stop of the kinds that are stated."""
        levels = {kind: getattr(self, kind.name.lower()) for kind in Kind}
        return {kind: (level.warn, level.stop) for kind, level in levels.items() if level}

    def mistakes(self, supply: float) -> Iterator[tuple[str, str]]:
        """Yield key and mistake of what cannot be for a robot with a supply of `supply` V."""
        for kind, (warn, stop) in self.given().items():
            key, low = kind.name.lower(), kind is Kind.SUPPLY_LOW
            if warn < stop if low else warn > stop:
                yield key, f"the warning at {warn:g} would come after the stop at {stop:g}"
            if kind in (Kind.SUPPLY_LOW, Kind.SUPPLY_HIGH) and (low == (warn >= supply)):
                side = "below" if low else "above"
                yield key, f"the warning at {warn:g} V is not {side} drive.supply, {supply:g} V"
