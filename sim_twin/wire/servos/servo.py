"""An X-series servo on a bus: its identity, and its execution of instructions."""

from collections.abc import Sequence

from windup.hal.servos.servo_model import ServoModel
from windup.sim_twin.wire.servos.backup import RESTORE, STORE
from windup.sim_twin.wire.servos.firmware import Firmware
from windup.sim_twin.wire.servos.health import OVERLOAD
from windup.sim_twin.wire.servos.present_registers import MOTION
from windup.sim_twin.wire.servos.protocol1_errors import protocol1_error
from windup.sim_twin.wire.servos.register_file import (
    BAD_ACCESS,
    BAD_INSTRUCTION,
    BAD_RANGE,
    FAILED,
    OK,
    TableItem,
)
from windup.sim_twin.wire.servos.x_series import BAUD_RATES, PRESENT, XSeriesModel
from windup.sim_twin.wire.shafts.shaft import Shaft

BOOT_SECONDS = 0.3  # time without answers after a reboot, s, assumed


class Servo:
    """One servo. The bus calls it to execute instructions, the world to advance time.

    Args:
        model: Description of its control table.
        servo: Data sheet.
        shaft: The shaft that it drives.
        identifier: Bus id.
        baud: Baud rate.
        supply: Supply voltage, V.
        **registers: Other registers that differ from the factory defaults, by name.
    """

    def __init__(
        self,
        model: XSeriesModel,
        servo: ServoModel,
        shaft: Shaft,
        identifier: int = 1,
        baud: int = 57600,
        supply: float = 12.0,
        **registers: int,
    ) -> None:
        self.model = model
        self.firmware = Firmware(model, servo, shaft, supply)
        self.registers = self.firmware.registers
        self._registered: tuple[int, bytes] | None = None
        self._ready = 0.0
        given = {"id": identifier, "baud_rate": BAUD_RATES.index(baud), **registers}
        for name, value in given.items():
            self.registers.set(name, value)
        self.firmware.restart(0.0)

    @property
    def name(self) -> str:
        """Name for messages."""
        return f"{self.model.name} {self.identifier}"

    @property
    def identifier(self) -> int:
        """Bus id."""
        return self.registers.memory[7]

    @property
    def secondary_id(self) -> int:
        """Secondary id, whose instructions it executes without answering; 253 and up: none."""
        return self.registers.memory[12]

    @property
    def protocol(self) -> int:
        """Protocol version; a new one is effective at once, as with id and baud rate (assumed).

        The remote control protocols of the X330 are not emulated: without their signal at start-up
        such a servo uses protocol 2 (e-Manual of the XL330, Protocol Type).
        """
        return 1 if self.registers.memory[13] == 1 else 2

    @property
    def baud(self) -> int:
        """Baud rate."""
        return BAUD_RATES[self.registers.memory[8]]

    @property
    def return_delay(self) -> float:
        """Delay from the end of an instruction to the status packet, s."""
        return self.registers.memory[9] * 2e-6

    @property
    def return_level(self) -> int:
        """Status return level: 0 answers pings, 1 also reads, 2 all instructions."""
        return self.registers.memory[68]

    @property
    def fast(self) -> bool:
        """Whether its firmware supports fast sync and fast bulk read."""
        since = self.model.fast_since
        return since is not None and self.registers.get("firmware_version") >= since

    @property
    def busy(self) -> bool:
        """Whether `control` must be called at every step."""
        return self.firmware.loop.busy

    @property
    def driving(self) -> bool:
        """Whether it drives its motor now."""
        return self.firmware.driving

    @property
    def supply(self) -> float:
        """Supply voltage, V."""
        return self.firmware.loop.supply

    def listens(self, now: float) -> bool:
        """Whether it is powered and has booted."""
        return self.firmware.powered and now >= self._ready

    def ping(self) -> bytes:
        """Return model number and firmware version."""
        memory = self.registers.memory
        return bytes((memory[0], memory[1], memory[6]))

    def sample(self) -> None:
        """Take the sample of the shaft that the next `read` reports."""
        self.firmware.present.sample()

    def read(self, address: int, count: int, now: float) -> tuple[int, bytes]:
        """Return the error byte and the data of a read instruction."""
        if self.registers.touches(address, count, *PRESENT):
            firmware = self.firmware
            motion = address >= MOTION.start and address + count <= MOTION.stop
            firmware.present.write(now, firmware.driving, firmware.health.temperature, motion)
        data = self.registers.read(address, count)
        if data is None:
            return self._error_byte(BAD_ACCESS), b""
        return self._error_byte(OK), data

    def write(self, address: int, data: bytes, now: float) -> int:
        """Execute a write and return the error byte."""
        error, writes = self.registers.check(address, data, self.firmware.torque_on)
        error = error or self.firmware.check_writes(writes)
        if error:
            return self._error_byte(error, writes)
        said = self._error_byte(OK)  # before a write that may change the protocol
        self.registers.commit(writes)
        for item, value in writes:
            self.firmware.apply_write(item.name, value, now)
        return said

    def register_write(self, address: int, data: bytes) -> int:
        """Store a write for `action` and return the error byte."""
        error, writes = self.registers.check(address, data, self.firmware.torque_on)
        error = error or self.firmware.check_writes(writes)
        if not error:
            self._registered = (address, data)
            self.registers.set("registered_instruction", 1)
        return self._error_byte(error, writes)

    def action(self, now: float) -> int:
        """Execute the stored write and return the error byte."""
        if self._registered is None:
            return self._error_byte(BAD_INSTRUCTION)
        address, data = self._registered
        self._registered = None
        self.registers.set("registered_instruction", 0)
        return self.write(address, data, now)

    def reboot(self, now: float) -> None:
        """Reboot: RAM and errors are reset, torque is off."""
        self._ready = now + BOOT_SECONDS
        self._registered = None
        self.firmware.restart(now)

    def factory_reset(self, option: int, broadcast: bool, now: float) -> int:
        """Reset everything (0xFF), all but id (1), or all but id and baud rate (2); then reboot."""
        keep = {0xFF: (), 0x01: ("id",), 0x02: ("id", "baud_rate")}.get(option)
        if keep is None or (broadcast and option == 0xFF):
            return self._error_byte(BAD_RANGE)
        if self.firmware.torque_on:
            return self._error_byte(BAD_ACCESS)
        items = [item for item in self.registers.eeprom() if item.name not in keep]
        self.registers.reset(items)
        self.reboot(now)
        return OK

    def clear(self, parameters: bytes) -> int:
        """Forget the turns and return the error byte; refused while moving."""
        if parameters != b"\x01DXL\x22":
            return self._error_byte(BAD_RANGE)
        self.sample()
        if self.firmware.present.moving:
            return self._error_byte(FAILED)
        self.firmware.hold_here(forget=True)
        return self._error_byte(OK)

    def backup(self, parameters: bytes, now: float) -> int:
        """Store the control table, or restore its EEPROM and reboot; return the error byte.

        No manual states the answer to a restore without a backup: Result Fail is assumed.
        """
        firmware, backup = self.firmware, self.firmware.backup
        if not backup.is_supported:
            return self._error_byte(BAD_INSTRUCTION)
        if parameters not in (STORE, RESTORE):
            return self._error_byte(BAD_RANGE)
        if firmware.torque_on or (parameters == RESTORE and not backup.ready):
            return self._error_byte(FAILED)
        if parameters == STORE:
            backup.store()
        else:
            backup.restore()
            self.reboot(now)
        return self._error_byte(OK)

    def overload(self, now: float) -> None:
        """Enter the overload state."""
        self.firmware.health.inject(OVERLOAD)
        self.firmware.protect(now)

    def heat(self, degrees: float) -> None:
        """Keep the motor at least this hot, degrees C; -inf lets it cool again."""
        self.firmware.health.heat(degrees)

    def control(self, now: float, dt: float) -> None:
        """Run one step of the control loop; needed while `busy`."""
        self.firmware.control(now, dt)

    def watch(self, now: float, dt: float, last_instruction: float) -> None:
        """Check watchdog and health, periodically; `last_instruction` is a time, s."""
        self.firmware.watch(now, dt, last_instruction)

    def set_supply(self, volts: float, now: float) -> None:
        """Change the supply voltage, V; at 0 V the servo is off, and boots when powered again."""
        if volts > 0.0 and not self.firmware.powered:
            self._ready = now + BOOT_SECONDS
        self.firmware.set_supply(volts, now)

    def _error_byte(self, error: int, writes: Sequence[tuple[TableItem, int]] = ()) -> int:
        """Return the error byte of a status packet, in the present protocol."""
        firmware = self.firmware
        if self.protocol == 1:
            return protocol1_error(error, firmware.health.errors, {item.name for item, _ in writes})
        return firmware.alert | error
