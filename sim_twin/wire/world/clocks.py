"""The clocks of a world: time that waits for somebody to wait, and the wall's."""

import time as wall
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from windup.sim_twin.wire.world.bus_world import BusWorld


class VirtualClock:
    """Time that passes only when somebody waits for it."""

    def __init__(self, world: "BusWorld") -> None:
        self.world = world

    def now(self) -> float:
        """Return the world's time, s."""
        return self.world.schedule.now

    def wait_until(self, time: float) -> None:
        """Bring the world to `time` s."""
        self.world.advance(time)

    def settle(self) -> None:
        """Nothing to catch up with: the world waits."""


class RealClock:
    """Time of the wall, from 0 at the start; the world is brought along when somebody asks."""

    def __init__(self, world: "BusWorld") -> None:
        self.world = world
        self._start = wall.monotonic() - world.now

    def now(self) -> float:
        """Return the time since the start, s."""
        return wall.monotonic() - self._start

    def wait_until(self, time: float) -> None:
        """Sleep until it is `time` s."""
        while (left := time - self.now()) > 0.0:
            wall.sleep(min(left, 0.002))
            self.world.advance(self.now())

    def settle(self) -> None:
        """Bring the world to now."""
        self.world.advance(self.now())


WireClock = VirtualClock | RealClock
