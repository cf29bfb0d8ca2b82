"""The clocks of a world: virtual time, and the wall clock."""

import time as wall
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from windup.sim_twin.wire.world.bus_world import BusWorld


class VirtualClock:
    """A clock that advances only in waits."""

    def __init__(self, world: "BusWorld") -> None:
        self.world = world

    def now(self) -> float:
        """Return the world's time, s."""
        return self.world.schedule.now

    def wait_until(self, time: float) -> None:
        """Advance the world to `time`, s."""
        self.world.advance(time)

    def settle(self) -> None:
        """Execute what is due at this instant, such as a fault that has been added just now."""
        schedule = self.world.schedule
        if schedule.next <= schedule.now:
            self.world.advance(schedule.now)


class RealClock:
    """Wall-clock time, from 0 at the start; the world advances when the clock is used."""

    def __init__(self, world: "BusWorld") -> None:
        self.world = world
        self._start = wall.monotonic() - world.now

    def now(self) -> float:
        """Return the time since the start, s."""
        return wall.monotonic() - self._start

    def wait_until(self, time: float) -> None:
        """Sleep until `time`, s, and advance the world."""
        while (left := time - self.now()) > 0.0:
            wall.sleep(min(left, 0.002))
            self.world.advance(self.now())

    def settle(self) -> None:
        """Advance the world to the present time."""
        self.world.advance(self.now())


WireClock = VirtualClock | RealClock
