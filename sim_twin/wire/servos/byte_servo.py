"""A protocol 1 servo on a bus: what AX, MX and Feetech servos have in common."""

import math
from abc import ABC, abstractmethod

from windup.sim_twin.wire.servos.byte_table import ByteTable, Writes
from windup.sim_twin.wire.servos.health import AMBIENT, warmed
from windup.sim_twin.wire.servos.motor_loop import MotorLoop

BOOT_SECONDS = 0.3  # silence after a reset, assumed
RETURN_DELAY_UNIT = 2e-6  # s
NO_ID = 255


def magnitude(value: float, bit: int) -> int:
    """Return a rounded value as a magnitude with a sign bit, within two bytes.

    >>> hex(magnitude(-5.2, 10))
    '0x405'
    """
    size = min(round(abs(value)), (1 << bit) - 1)
    return size | 1 << bit if value < 0.0 and size else size


class ByteServo(ABC):
    """One servo. The bus calls it with instructions, the world with time.

    Args:
        name: Its model.
        table: Its control table.
        loop: What it drives.
        identifier: Its id.
        baud: Its baud rate.
        **registers: Other registers that differ from the factory's, by name.

    Attributes:
        model: Its model.
        table: Its control table.
        loop: Its control loop.
        torque_on: Whether its motor is switched on.
        powered: Whether it has a supply voltage.
        temperature: Of its motor, degrees C.
        floor: Heat from outside, degrees C: the motor is no cooler.
        errors: Bits of the error byte of its answers.
    """

    bauds: dict[int, int]  # baud rate to the value of its register
    live: int  # the first register that changes by itself
    live_motion: int  # the end of those that a control loop reads
    min_voltage: str
    max_voltage: str

    def __init__(
        self,
        name: str,
        table: ByteTable,
        loop: MotorLoop,
        identifier: int,
        baud: int,
        **registers: int,
    ) -> None:
        self.model, self.table, self.loop = name, table, loop
        self.torque_on = False
        self.powered = True
        self.temperature, self.floor = AMBIENT, -math.inf
        self.errors = 0
        self._ready = 0.0
        self._strained = 0.0
        self._registered: tuple[int, bytes] | None = None
        self._rates = {code: rate for rate, code in self.bauds.items()}
        for key, value in {"id": identifier, "baud_rate": self.bauds[baud], **registers}.items():
            table.set(key, value)
            table.save(key)
        self.restart(0.0)

    # Who it is

    @property
    def name(self) -> str:
        """What people call it."""
        return f"{self.model} {self.identifier}"

    @property
    def identifier(self) -> int:
        """Its id."""
        return self.table.get("id")

    @property
    def shadow(self) -> int:
        """It has no second id."""
        return NO_ID

    @property
    def protocol(self) -> int:
        """It speaks protocol 1."""
        return 1

    @property
    def baud(self) -> int:
        """Its baud rate."""
        return self._rates.get(self.table.get("baud_rate"), 0)

    @property
    def return_delay(self) -> float:
        """From the end of an instruction to its answer, s."""
        return self.table.get("return_delay_time") * RETURN_DELAY_UNIT

    @property
    @abstractmethod
    def return_level(self) -> int:
        """What it answers: 0 pings, 1 reads as well, 2 everything."""

    @property
    def fast(self) -> bool:
        """It knows no fast sync read."""
        return False

    @property
    def busy(self) -> bool:
        """Whether `control` has to be called at every step."""
        return self.loop.busy

    @property
    def driving(self) -> bool:
        """Whether it really drives its motor now."""
        return self.torque_on and self.powered

    @property
    def supply(self) -> float:
        """Its supply voltage, V."""
        return self.loop.supply

    def listens(self, now: float) -> bool:
        """Whether it is powered and has booted."""
        return self.powered and now >= self._ready

    # What instructions do to it

    def ping(self) -> bytes:
        """Return nothing: an answer to a ping has no data."""
        return b""

    def sample(self) -> None:
        """Take the sample of the shaft that the next `read` reports."""
        self.loop.sample()

    def read(self, address: int, count: int, now: float) -> tuple[int, bytes]:
        """Return the error byte and the data of a read."""
        if address + count > self.live:
            self.show(now, address + count <= self.live_motion)
        return self.errors, self.table.read(address, count)

    def write(self, address: int, data: bytes, now: float) -> int:
        """Do a write and return the error byte."""
        error, writes = self.check(address, data)
        if not error:
            for field, value in writes:
                self.table.set(field.name, value)
                self.keep(field.name)
            self.act({field.name for field, _ in writes}, now)
        return self.errors | error

    def register_write(self, address: int, data: bytes) -> int:
        """Keep a write for `action` and return the error byte."""
        error, _ = self.check(address, data)
        if not error:
            self._registered = (address, data)
        return self.errors | error

    def action(self, now: float) -> int:
        """Do the write that is kept, if there is one, and return the error byte."""
        if self._registered is None:
            return self.errors
        (address, data), self._registered = self._registered, None
        return self.write(address, data, now)

    def reboot(self, now: float) -> None:
        """Start again: what was not saved is lost, torque is off."""
        self._ready = now + BOOT_SECONDS
        self.restart(now)

    def factory_reset(self, option: int, broadcast: bool, now: float) -> int:
        """Save the factory's values, also of id and baud rate, and start again."""
        self.table.factory()
        self.reboot(now)
        return 0

    def clear(self, parameters: bytes) -> int:
        """Protocol 1 has no such instruction."""
        return self.errors

    def backup(self, parameters: bytes, now: float) -> int:
        """Protocol 1 has no such instruction."""
        return self.errors

    # What time does to it

    def control(self, now: float, dt: float) -> None:
        """Do one step of the control loop; needed while `busy`."""
        if self.driving:
            self.loop.update(now, dt)

    def watch(self, now: float, dt: float, heard: float) -> None:
        """Look after itself, every now and then. It has no watchdog: `heard` is of no interest."""
        if not self.powered:
            return
        loop = self.loop
        loop.sample()
        current = loop.effort / loop.constant if self.driving else 0.0
        warm = warmed(self.temperature, current, loop.resistance, dt)
        self.temperature = max(warm, self.floor)
        self.protect(now, dt)

    def heat(self, degrees: float) -> None:
        """Have a motor that is this hot, degrees C, and stays so; -inf: it may cool again."""
        self.floor = degrees
        self.temperature = max(self.temperature, degrees)

    def voltage_is_wrong(self) -> bool:
        """Whether the supply is outside of its limits."""
        tenths = round(self.loop.supply * 10.0)
        return not self.table.get(self.min_voltage) <= tenths <= self.table.get(self.max_voltage)

    def set_supply(self, volts: float, now: float) -> None:
        """Change the supply voltage; at 0 V the servo is off and starts again later."""
        was, self.powered = self.powered, volts > 0.0
        self.loop.supply = volts
        if self.powered and not was:
            self.reboot(now)
        elif not self.powered:
            self.torque_on = False
            self.loop.release()
        elif self.driving:
            self.loop.update(now)

    def restart(self, now: float) -> None:
        """Start as after power-up."""
        self.table.power_up()
        self.torque_on = False
        self.errors = 0
        self._strained = 0.0
        self._registered = None
        self.loop.release()
        self.loop.hold_here()
        self.begin()

    # What tells one family from the other

    @abstractmethod
    def begin(self) -> None:
        """Set the registers that are not constant at power-up."""

    @abstractmethod
    def check(self, address: int, data: bytes) -> tuple[int, Writes]:
        """Return the error of a write, and what it would set."""

    @abstractmethod
    def keep(self, name: str) -> None:
        """Save a field that has been written, unless a lock forbids that."""

    @abstractmethod
    def act(self, names: set[str], now: float) -> None:
        """Act on fields that have been written together."""

    @abstractmethod
    def show(self, now: float, motion: bool) -> None:
        """Write the last sample into the registers; where `motion`, only the first few."""

    @abstractmethod
    def protect(self, now: float, dt: float) -> None:
        """Set the error bits, and let go where the registers say so."""

    @abstractmethod
    def overload(self, now: float) -> None:
        """Take itself for overloaded."""
