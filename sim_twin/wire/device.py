"""Interface of the devices on a bus."""

from typing import Protocol


class Device(Protocol):
    """A servo or a board on a bus; see `Servo` for the details of each member.

    Error bytes are those of its protocol's status packet. Times are the world's, s.
    """

    @property
    def name(self) -> str:
        """Name for messages."""
        ...

    @property
    def identifier(self) -> int:
        """Bus id."""
        ...

    @property
    def secondary_id(self) -> int:
        """Secondary id, whose instructions it executes without answering; 253 and up: none."""
        ...

    @property
    def protocol(self) -> int:
        """Protocol version, 1 or 2."""
        ...

    @property
    def baud(self) -> int:
        """Baud rate."""
        ...

    @property
    def return_delay(self) -> float:
        """Delay from the end of an instruction to the status packet, s."""
        ...

    @property
    def return_level(self) -> int:
        """Status return level: 0 answers pings, 1 also reads, 2 all instructions."""
        ...

    @property
    def fast(self) -> bool:
        """Whether it supports fast sync and fast bulk read."""
        ...

    @property
    def busy(self) -> bool:
        """Whether `control` must be called at every physics step."""
        ...

    @property
    def driving(self) -> bool:
        """Whether it drives a motor now: torque is on and power is present."""
        ...

    @property
    def supply(self) -> float:
        """Supply voltage, V."""
        ...

    def listens(self, now: float) -> bool:
        """Whether it is powered and has booted."""
        ...

    def ping(self) -> bytes:
        """Return model number and firmware version."""
        ...

    def sample(self) -> None:
        """Take the sample that the next `read` reports."""
        ...

    def read(self, address: int, count: int, now: float) -> tuple[int, bytes]:
        """Return the error byte and the data of a read instruction."""
        ...

    def write(self, address: int, data: bytes, now: float) -> int:
        """Execute a write and return the error byte."""
        ...

    def register_write(self, address: int, data: bytes) -> int:
        """Store a write for `action` and return the error byte."""
        ...

    def action(self, now: float) -> int:
        """Execute the stored write and return the error byte."""
        ...

    def reboot(self, now: float) -> None:
        """Reboot."""
        ...

    def factory_reset(self, option: int, broadcast: bool, now: float) -> int:
        """Reset the control table and return the error byte."""
        ...

    def clear(self, parameters: bytes) -> int:
        """Execute a Clear instruction and return the error byte."""
        ...

    def backup(self, parameters: bytes, now: float) -> int:
        """Execute a Control Table Backup instruction and return the error byte."""
        ...

    def overload(self, now: float) -> None:
        """Enter the overload state, as if the horn were blocked."""
        ...

    def heat(self, degrees: float) -> None:
        """Keep the motor at least this hot, degrees C; -inf lets it cool again."""
        ...

    def control(self, now: float, dt: float) -> None:
        """Run one step of the control loop."""
        ...

    def watch(self, now: float, dt: float, last_instruction: float) -> None:
        """Check protection and watchdog, periodically; `last_instruction` is a time, s."""
        ...

    def set_supply(self, volts: float, now: float) -> None:
        """Change the supply voltage, V."""
        ...
