"""What hangs on a bus."""

from typing import Protocol


class Device(Protocol):
    """A servo or a board on a bus; see `Servo` for what each part means.

    Error bytes are those of its protocol's status frame. Times are the world's, s.
    """

    @property
    def name(self) -> str:
        """What people call it."""
        ...

    @property
    def identifier(self) -> int:
        """Its id."""
        ...

    @property
    def shadow(self) -> int:
        """A second id, on whose instructions it acts without an answer; 253 and up: none."""
        ...

    @property
    def protocol(self) -> int:
        """The protocol that it speaks, 1 or 2."""
        ...

    @property
    def baud(self) -> int:
        """Its baud rate."""
        ...

    @property
    def return_delay(self) -> float:
        """From the end of an instruction to its answer, s."""
        ...

    @property
    def return_level(self) -> int:
        """What it answers: 0 pings, 1 reads as well, 2 everything."""
        ...

    @property
    def fast(self) -> bool:
        """Whether it knows fast sync and fast bulk read."""
        ...

    @property
    def busy(self) -> bool:
        """Whether `control` has to be called at every physics step."""
        ...

    @property
    def driving(self) -> bool:
        """Whether it really drives a motor now."""
        ...

    @property
    def supply(self) -> float:
        """Its supply voltage, V."""
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
        """Return the error byte and the data of a read."""
        ...

    def write(self, address: int, data: bytes, now: float) -> int:
        """Do a write and return the error byte."""
        ...

    def register_write(self, address: int, data: bytes) -> int:
        """Keep a write for `action` and return the error byte."""
        ...

    def action(self, now: float) -> int:
        """Do the write that is kept and return the error byte."""
        ...

    def reboot(self, now: float) -> None:
        """Start again."""
        ...

    def factory_reset(self, option: int, broadcast: bool, now: float) -> int:
        """Reset the control table and return the error byte."""
        ...

    def clear(self, parameters: bytes) -> int:
        """Do a Clear instruction and return the error byte."""
        ...

    def backup(self, parameters: bytes, now: float) -> int:
        """Do a Control Table Backup instruction and return the error byte."""
        ...

    def overload(self, now: float) -> None:
        """Take itself for overloaded, as with a horn that is held."""
        ...

    def heat(self, degrees: float) -> None:
        """Have a motor that is this hot, degrees C, and stays so; -inf: it may cool again."""
        ...

    def control(self, now: float, dt: float) -> None:
        """Do one step of the control loop."""
        ...

    def watch(self, now: float, dt: float, heard: float) -> None:
        """Look after itself, every now and then; `heard` is the last instruction."""
        ...

    def set_supply(self, volts: float, now: float) -> None:
        """Change the supply voltage."""
        ...
