"""``twin://`` as an I2C bus, with the chip of an emulated robot's IMU."""

import errno

from windup.hal.errors import UsageError
from windup.sim_twin.wire.imu.bno055 import Bno055Registers
from windup.sim_twin.wire.world.address import parse_address
from windup.sim_twin.wire.world.clocks import WireClock
from windup.sim_twin.wire.world.worlds import open_world, release_world

CLOCK_RATE = 400_000.0
"""Bits a second of the bus."""
OVERHEAD = 4
"""Bytes of a read besides its data: address, register, address again, start and stop."""


class TwinI2c:
    """A chip on the I2C bus of a world; see `windup.hal.imu.i2c.I2cChip`.

    Args:
        url: URL of the IMU's port in the world.

    Raises:
        UsageError: The IMU there is not on I2C.
    """

    def __init__(self, url: str) -> None:
        address = parse_address(url)
        self._running = open_world(address)
        self._bus = self._running.world.bus(address.bus)
        chip = self._bus.chip
        if chip is None:
            release_world(self._running)
            raise UsageError(f"{url}: this world has no chip on I2C")
        self._chip: Bno055Registers = chip
        self._open = True

    @property
    def clock(self) -> WireClock:
        """The world's clock."""
        return self._running.clock

    def read(self, register: int, count: int) -> bytes:
        """Return registers, after the time that they take on the bus."""
        self._transfer(count)
        return self._chip.read(register, count)

    def write(self, register: int, value: int) -> None:
        """Set a register."""
        self._transfer(1)
        self._chip.write(register, value)

    def close(self) -> None:
        """Leave the world."""
        if self._open:
            self._open = False
            release_world(self._running)

    def _transfer(self, count: int) -> None:
        """Let the time of a transfer pass.

        Raises:
            OSError: The bus is unplugged.
        """
        if not self._bus.plugged:
            raise OSError(errno.ENXIO, "No such device or address")
        self.clock.wait_until(self.clock.now() + 9.0 * (count + OVERHEAD) / CLOCK_RATE)


def open_twin_i2c(url: str, address: int) -> TwinI2c:
    """Open the IMU's chip in a world, whatever its `address` on the bus."""
    return TwinI2c(url)
