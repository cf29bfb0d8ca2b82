"""PortHandlers of the makers' SDKs that open an emulated bus and live on its virtual clock.

The SDKs' PortHandlers open a device by themselves and ask `time.time` how long they have waited, so
on a virtual clock no time would ever pass. Here a class is made of the installed SDK's own
PortHandler that differs from it in just that: what it opens, and which clock it looks at. Packet
handlers, groups and whatever else takes a PortHandler work with it unchanged, with all their
defects; nothing in the SDK's modules is replaced.
"""

from collections.abc import Callable
from importlib import import_module
from typing import Any, Final, Literal

import serial

from windup.hal.backend import Clock
from windup.hal.errors import UsageError, suggest

Sdk = Literal["dynamixel", "feetech"]

MODULES: Final[dict[str, str]] = {"dynamixel": "dynamixel_sdk", "feetech": "scservo_sdk"}
"""Import names; feetech-servo-sdk and ftservo-python-sdk share theirs."""
POLL: Final = 10e-6
"""What a question costs: a program that polls sees time pass, as on a real port, s."""
BITS: Final = 10.0
"""A byte on the wire: start, eight, stop."""


class VirtualTime:
    """What differs from the SDK's PortHandler; its names are the SDK's, its times ms.

    Attributes:
        url: What is opened, whatever the port is called.
        clock: The clock of the world behind it.
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
        """Open the bus, or open it again at another baud rate."""
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
        """Return how many bytes have come."""
        self._poll()
        return int(self.ser.in_waiting)

    def readPort(self, length: int) -> bytes:  # noqa: N802
        """Return up to `length` bytes: all of them, or what has come when the packet's time is up.

        The SDK would ask again and again until then; so its loop goes round once.
        """
        if length <= 0:
            return b""
        end = (self.packet_start_time + self.packet_timeout) * 1e-3
        self.ser.timeout = max(end - self.clock.now(), 0.0) + POLL
        return bytes(self.ser.read(length))

    def _poll(self) -> None:
        """Let the time of one question pass."""
        self.clock.wait_until(self.clock.now() + POLL)


def port_handler_class(sdk: Sdk, url: str, clock: Clock) -> type[Any]:
    """Return a subclass of an SDK's PortHandler whose ports all lead to `url`.

    Args:
        sdk: Whose SDK: "dynamixel" (dynamixel_sdk) or "feetech" (scservo_sdk).
        url: The emulated bus.
        clock: Its clock.

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
