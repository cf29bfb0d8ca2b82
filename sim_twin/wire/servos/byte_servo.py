"""A protocol 1 servo on a bus: the common part of AX, MX and Feetech servos."""

import math
from abc import ABC, abstractmethod

from windup.sim_twin.wire.servos.byte_table import ByteTable, Writes
from windup.sim_twin.wire.servos.health import AMBIENT, motor_temperature
from windup.sim_twin.wire.servos.motor_loop import MotorLoop

BOOT_SECONDS = 0.3  # time without answers after a reset, s, assumed
RETURN_DELAY_UNIT = 2e-6  # s
NO_ID = 255


def magnitude(value: float, bit: int) -> int:
    """Return a rounded value as magnitude and sign bit, limited to `bit` bits of magnitude.

    >>> hex(magnitude(-5.2, 10))
    '0x405'
    """
    size = min(round(abs(value)), (1 << bit) - 1)
    return size | 1 << bit if value < 0.0 and size else size


class ByteServo(ABC):
    """One servo. The bus calls it to execute instructions, the world to advance time.

    Args:
        name: Model name.
        table: Control table.
        loop: Control loop of its motor.
        identifier: Bus id.
        baud: Baud rate.
        **registers: Other registers that differ from the factory defaults, by name.

    Attributes:
        model: Model name.
        table: Control table.
        loop: Control loop.
        torque_on: Whether torque is enabled.
        powered: Whether it has a supply voltage.
        temperature: Temperature of its motor, degrees C.
        minimum_temperature: Lowest temperature of the motor, set by a heat fault, degrees C.
        errors: Bits of the error byte of its status packets.
    """

    bauds: dict[int, int]  # baud rate to the value of its register
    live: int  # address of the first register that changes by itself
    live_motion: int  # end of the registers that a host's control loop reads
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
        self.temperature, self.minimum_temperature = AMBIENT, -math.inf
        self.errors = 0
        self._ready = 0.0
        self._strained = 0.0
        self._registered: tuple[int, bytes] | None = None
        self._rates = {code: rate for rate, code in self.bauds.items()}
        for key, value in {"id": identifier, "baud_rate": self.bauds[baud], **registers}.items():
            table.set(key, value)
            table.save(key)
        self.restart(0.0)

    # Identity and state

    @property
    def name(self) -> str:
        """Name for messages."""
        return f"{self.model} {self.identifier}"

    @property
    def identifier(self) -> int:
        """Bus id."""
        return self.table.get("id")

    @property
    def secondary_id(self) -> int:
        """No secondary id."""
        return NO_ID

    @property
    def protocol(self) -> int:
        """Protocol version, 1."""
        return 1

    @property
    def baud(self) -> int:
        """Baud rate."""
        return self._rates.get(self.table.get("baud_rate"), 0)

    @property
    def return_delay(self) -> float:
        """Delay from the end of an instruction to the status packet, s."""
        return self.table.get("return_delay_time") * RETURN_DELAY_UNIT

    @property
    @abstractmethod
    def return_level(self) -> int:
        """Status return level: 0 answers pings, 1 also reads, 2 all instructions."""

    @property
    def fast(self) -> bool:
        """False: fast sync read is not supported."""
        return False

    @property
    def busy(self) -> bool:
        """Whether `control` must be called at every step."""
        return self.loop.busy

    @property
    def driving(self) -> bool:
        """Whether it drives its motor now: torque is on and power is present."""
        return self.torque_on and self.powered

    @property
    def supply(self) -> float:
        """Supply voltage, V."""
        return self.loop.supply

    def listens(self, now: float) -> bool:
        """Whether it is powered and has booted."""
        return self.powered and now >= self._ready

    # Instructions

    def ping(self) -> bytes:
        """Return no data: a protocol 1 ping is answered without any."""
        return b""

    def sample(self) -> None:
        """Take the sample of the shaft that the next `read` reports."""
        self.loop.sample()

    def read(self, address: int, count: int, now: float) -> tuple[int, bytes]:
        """Return the error byte and the data of a read instruction."""
        if address + count > self.live:
            self.write_sample(now, address + count <= self.live_motion)
        return self.errors, self.table.read(address, count)

    def write(self, address: int, data: bytes, now: float) -> int:
        """Execute a write and return the error byte."""
        error, writes = self.check(address, data)
        if not error:
            for field, value in writes:
                self.table.set(field.name, value)
                self.save_field(field.name)
            self.apply_fields({field.name for field, _ in writes}, now)
        return self.errors | error

    def register_write(self, address: int, data: bytes) -> int:
        """Store a write for `action` and return the error byte."""
        error, _ = self.check(address, data)
        if not error:
            self._registered = (address, data)
        return self.errors | error

    def action(self, now: float) -> int:
        """Execute the stored write, if there is one, and return the error byte."""
        if self._registered is None:
            return self.errors
        (address, data), self._registered = self._registered, None
        return self.write(address, data, now)

    def reboot(self, now: float) -> None:
        """Reboot: unsaved values are lost and torque is off."""
        self._ready = now + BOOT_SECONDS
        self.restart(now)

    def factory_reset(self, option: int, broadcast: bool, now: float) -> int:
        """Restore the factory values, including id and baud rate, and reboot."""
        self.table.reset_to_factory()
        self.reboot(now)
        return 0

    def clear(self, parameters: bytes) -> int:
        """Do nothing: protocol 1 has no such instruction."""
        return self.errors

    def backup(self, parameters: bytes, now: float) -> int:
        """Do nothing: protocol 1 has no such instruction."""
        return self.errors

    # Calls of the world

    def control(self, now: float, dt: float) -> None:
        """Run one step of the control loop; needed while `busy`."""
        if self.driving:
            self.loop.update(now, dt)

    def watch(self, now: float, dt: float, last_instruction: float) -> None:
        """Update temperature and protection, periodically; there is no watchdog."""
        if not self.powered:
            return
        loop = self.loop
        loop.sample()
        current = loop.effort / loop.constant if self.driving else 0.0
        warm = motor_temperature(self.temperature, current, loop.resistance, dt)
        self.temperature = max(warm, self.minimum_temperature)
        self.protect(now, dt)

    def heat(self, degrees: float) -> None:
        """Keep the motor at least this hot, degrees C; -inf lets it cool again."""
        self.minimum_temperature = degrees
        self.temperature = max(self.temperature, degrees)

    def voltage_is_wrong(self) -> bool:
        """Return whether the supply is outside of the voltage limits."""
        tenths = round(self.loop.supply * 10.0)
        return not self.table.get(self.min_voltage) <= tenths <= self.table.get(self.max_voltage)

    def set_supply(self, volts: float, now: float) -> None:
        """Change the supply voltage, V; at 0 V the servo is off, and boots when powered again."""
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
        """Enter the state after power-up."""
        self.table.power_up()
        self.torque_on = False
        self.errors = 0
        self._strained = 0.0
        self._registered = None
        self.loop.release()
        self.loop.hold_here()
        self.init_registers()

    # Differences between the families

    @abstractmethod
    def init_registers(self) -> None:
        """Set the registers that are not constant at power-up."""

    @abstractmethod
    def check(self, address: int, data: bytes) -> tuple[int, Writes]:
        """Return the error of a write, and the fields that it would set."""

    @abstractmethod
    def save_field(self, name: str) -> None:
        """Save a field that has been written, unless the EEPROM is locked."""

    @abstractmethod
    def apply_fields(self, names: set[str], now: float) -> None:
        """Apply the effects of fields that have been written together."""

    @abstractmethod
    def write_sample(self, now: float, motion: bool) -> None:
        """Write the last sample to the registers; with `motion`, only position, speed, load."""

    @abstractmethod
    def protect(self, now: float, dt: float) -> None:
        """Set the error bits, and switch the torque off if the registers demand it."""

    @abstractmethod
    def overload(self, now: float) -> None:
        """Enter the overload state."""
