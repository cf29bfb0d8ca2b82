"""PortHandlers of the makers' SDKs that open an emulated bus and use its virtual clock.

The SDKs' PortHandlers open a serial device and measure time-outs with `time.time`, so that virtual
time would never advance. The classes here are subclasses of the installed SDK's PortHandler that
differ only in the port that they open and the clock that they use. Packet handlers, groups and
other users of a PortHandler work with them unchanged, including their defects; nothing in the SDK's
modules is replaced.
"""

from collections.abc import Callable
from importlib import import_module
from typing import Any, Final, Literal

import serial

from windup.hal.backend import Clock
from windup.hal.errors import UsageError, suggest

Sdk = Literal["dynamixel", "feetech"]

MODULES: Final[dict[str, str]] = {"dynamixel": "dynamixel_sdk", "feetech": "scservo_sdk"}
"""Import names; feetech-servo-sdk and ftservo-python-sdk use the same one."""
POLL: Final = 10e-6
"""Virtual time that one poll of the port takes, so that polling loops end, s."""
BITS: Final = 10.0
"""Bits of one byte on the bus: start bit, eight data bits, stop bit."""


class VirtualTime:
    """The methods that differ from the SDK's PortHandler; names and times (ms) are the SDK's.

    Attributes:
        url: URL of the emulated bus, which is opened whatever the port's name is.
        clock: Clock of the bus.
    """

    url: str
    clock: Clock
    ser: Any
    is_open: bool
    baudrate: int
    tx_time_per_byte: float
    packet_start_time: float
    packet_timeout: float
    closePort: Callable[[], None]  # noqa: N815 - the SDK's name

    def setupPort(self, cflag_baud: int) -> bool:  # noqa: N802 - the SDK's name, as all below
        """Open the bus, or reopen it with another baud rate."""
        if self.is_open:
            self.closePort()
        self.ser = serial.serial_for_url(self.url, baudrate=cflag_baud, timeout=0)
        self.is_open = True
        self.ser.reset_input_buffer()
        self.tx_time_per_byte = 1000.0 * BITS / cflag_baud
        return True

    def getCurrentTime(self) -> float:  # noqa: N802
        """Return the world's time, ms."""
        self._poll()
        return self.clock.now() * 1e3

    def getBytesAvailable(self) -> int:  # noqa: N802
        """Return the number of bytes that have been received."""
        self._poll()
        return int(self.ser.in_waiting)

    def readPort(self, length: int) -> bytes:  # noqa: N802
        """Wait for `length` bytes until the packet times out; return the bytes received.

        The SDK polls until then; a blocking read has the same result in one call.
        """
        if length <= 0:
            return b""
        end = (self.packet_start_time + self.packet_timeout) * 1e-3
        self.ser.timeout = max(end - self.clock.now(), 0.0) + POLL
        return bytes(self.ser.read(length))

    def _poll(self) -> None:
        """Advance the clock by the time of one poll."""
        self.clock.wait_until(self.clock.now() + POLL)


def port_handler_class(sdk: Sdk, url: str, clock: Clock) -> type[Any]:
    """Return a subclass of an SDK's PortHandler whose instances all open `url`.

    Args:
        sdk: "dynamixel" (dynamixel_sdk) or "feetech" (scservo_sdk).
        url: URL of the emulated bus.
        clock: Clock of the bus.

    Raises:
        UsageError: There is no such SDK, or it is not installed.
    """
    if sdk not in MODULES:
        raise UsageError(f"unknown SDK {sdk!r}{suggest(sdk, MODULES)}")
    name = MODULES[sdk]
    try:
        base = import_module(name).PortHandler
    except ModuleNotFoundError as error:
        if error.name != name:
            raise
        raise UsageError(f"the {sdk} SDK ({name}) is not installed") from None
    return type("PortHandler", (VirtualTime, base), {"url": url, "clock": clock})
