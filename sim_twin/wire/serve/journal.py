"""Reports timestamped changes in a served world to callbacks."""

import time as wall
from collections.abc import Callable
from typing import Literal, NamedTuple

from windup.sim_twin.wire.world.bus_world import BusWorld

Journal = Callable[[float, int], None]


class Event(NamedTuple):
    """A change in a world.

    Attributes:
        time: Time of the change, s on the system's monotonic clock.
        kind: "driven": the number of driven motors changed; "unplugged" and "plugged": the adapter
            of a bus, which can be opened again from then on; "supply": the supply voltage changed.
        value: Number of driven motors, number of plugged adapters, or voltage, V.
        bus: Name of the adapter's bus.
    """

    time: float
    kind: Literal["driven", "plugged", "unplugged", "supply"]
    value: float
    bus: str = ""


class WorldWatcher:
    """Compares a world with its state at the previous call and reports the changes.

    Args:
        world: The world. Its initial state is reported to the journal only.
        journal: Called with the world's time, s, and the number of driven motors.
        events: Called with each change.
    """

    def __init__(
        self,
        world: BusWorld,
        journal: Journal | None = None,
        events: Callable[[Event], None] | None = None,
    ) -> None:
        self._world, self._journal, self._events = world, journal, events
        self._told = -1  # number of driven motors that the journal was called with last
        self._driven, self._volts = 0, world.volts
        self._plugged = dict.fromkeys(world.buses, True)

    def update(self, now: float) -> None:
        """Report changes; `now` is the world's time, s."""
        if self._journal is None and self._events is None:
            return
        driven = sum(device.driving for device in self._world.devices)
        if self._journal is not None and driven != self._told:
            self._told = driven
            self._journal(now, driven)
        if self._events is not None:
            self._compare(driven, self._events)

    def _compare(self, driven: int, tell: Callable[[Event], None]) -> None:
        """Report the changes as events."""
        volts = self._world.volts
        if volts != self._volts:
            self._volts = volts
            tell(Event(wall.monotonic(), "supply", volts))
        for name, bus in self._world.buses.items():
            if bus.plugged != self._plugged[name]:
                self._plugged[name] = bus.plugged
                count = sum(self._plugged.values())
                kind: Literal["plugged", "unplugged"] = "plugged" if bus.plugged else "unplugged"
                tell(Event(wall.monotonic(), kind, count, name))
        if driven != self._driven:
            self._driven = driven
            tell(Event(wall.monotonic(), "driven", driven))
