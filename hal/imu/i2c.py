"""Access to the registers of a chip on an I2C bus.

A URL is the bus's device file, and the chip's address where it has several:
``/dev/i2c-1`` or ``/dev/i2c-1?address=0x29``.
"""

import contextlib
import fcntl
import os
from collections.abc import Callable
from typing import Any, Protocol

from windup.hal.backend import Clock
from windup.hal.clock import WallClock
from windup.hal.errors import PortError, UsageError

LONGEST = 32
"""Maximum number of bytes of one read (SMBus 2.0, section 5.5.7)."""
I2C_RETRIES, I2C_TIMEOUT = 0x0701, 0x0702
"""Requests of ioctl (linux/i2c-dev.h)."""
TIMEOUT = 2
"""Time-out of a transfer, in units of 10 ms: a wire that is held low must not stop the loop."""


class I2cChip(Protocol):
    """One chip on an open I2C bus.

    Attributes:
        clock: The wall, or the clock of the world behind the bus.
    """

    @property
    def clock(self) -> Clock:
        """The clock that the bus lives on."""
        ...

    def read(self, register: int, count: int) -> bytes:
        """Return `count` registers, at most `LONGEST`, from `register` on.

        Raises:
            OSError: The chip did not answer.
        """
        ...

    def write(self, register: int, value: int) -> None:
        """Set one register.

        Raises:
            OSError: The chip did not answer.
        """
        ...

    def close(self) -> None:
        """Give the bus back."""
        ...


I2cOpener = Callable[[str, int], I2cChip]
HANDLERS: dict[str, I2cOpener] = {}
"""Maps a URL scheme, such as "twin", to its opener."""


def open_i2c(url: str, address: int) -> I2cChip:
    """Open a chip at `url`; `address` is used if the URL names none.

    Raises:
        PortError: The bus cannot be opened; the message says what to do.
        UsageError: The URL names no I2C bus.
    """
    scheme, separator, _ = url.partition("://")
    if separator:
        if scheme not in HANDLERS:
            known = ", ".join(["/dev/i2c-1", *(f"{name}://" for name in HANDLERS)])
            raise UsageError(f"{url}: no I2C bus; give one such as {known}")
        return HANDLERS[scheme](url, address)
    path, _, query = url.partition("?")
    return KernelChip(path, _address(url, query, address))


def _address(url: str, query: str, usual: int) -> int:
    """Return the chip's address from the query of a URL."""
    if not query:
        return usual
    key, _, text = query.partition("=")
    try:
        if key == "address" and 0x03 <= (address := int(text, 0)) <= 0x77:
            return address
    except ValueError:
        pass
    raise UsageError(f"{url}: after the ? give the address of the chip, as in ?address=0x29")


class KernelChip:
    """A chip on a bus of the Linux kernel, by `smbus2`.

    It sets the time-out of the bus, for all programs that use it, where the bus allows that.

    Args:
        path: Device file of the bus.
        address: Of the chip.
    """

    def __init__(self, path: str, address: int) -> None:
        try:
            from smbus2 import SMBus
        except ImportError:
            raise UsageError(
                f"{path}: I2C needs the package smbus2: pip install 'windup-robotics[imu]'"
            ) from None
        self.clock: Clock = WallClock()
        self._address = address
        try:
            bus: Any = SMBus(path)
        except OSError as error:
            raise PortError(_explain(path, error)) from None
        self._bus = bus
        with contextlib.suppress(OSError):
            fcntl.ioctl(bus.fd, I2C_RETRIES, 0)
            fcntl.ioctl(bus.fd, I2C_TIMEOUT, TIMEOUT)

    def read(self, register: int, count: int) -> bytes:
        """See `I2cChip`."""
        return bytes(self._bus.read_i2c_block_data(self._address, register, count))

    def write(self, register: int, value: int) -> None:
        """See `I2cChip`."""
        self._bus.write_byte_data(self._address, register, value)

    def close(self) -> None:
        """See `I2cChip`."""
        self._bus.close()


def _explain(path: str, error: OSError) -> str:
    if isinstance(error, FileNotFoundError):
        there = sorted(name for name in os.listdir("/dev") if name.startswith("i2c-"))
        listed = ", ".join(f"/dev/{name}" for name in there) or "none"
        return f"no I2C bus {path}; buses there are: {listed}"
    if isinstance(error, PermissionError):
        return f"no permission for {path}; `sudo usermod -aG i2c $USER`, then log in again"
    return f"{path} cannot be opened: {error.strerror or error}"
