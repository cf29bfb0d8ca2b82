"""A position servo of protocol 1 that is emulated from its registers and data sheet alone.

For the families that other distributions add. It does what every such servo does: it follows goals
with the stiffness of its P register, stays where it is when torque is switched on, reports what it
measures, and protects itself from heat, overload and a wrong supply. Registers without a meaning
here keep what is written to them. A servo that does more is a subclass of `ByteServo`.
"""

import math
from collections.abc import Mapping
from typing import Final

from windup.hal.errors import PluginError
from windup.hal.families import Family
from windup.hal.registers import Register
from windup.hal.servos.servo_model import ServoModel
from windup.sim_twin.wire.servos.byte_servo import ByteServo
from windup.sim_twin.wire.servos.byte_table import TWOS, ByteTable, Field, Writes
from windup.sim_twin.wire.servos.health import OVERLOAD_LEVEL, OVERLOAD_TIME
from windup.sim_twin.wire.servos.motor_loop import MotorLoop
from windup.sim_twin.wire.shafts.shaft import Shaft

ANSWERS_ALL: Final = 2
REPORTED: Final = (
    "present_position",
    "present_velocity",
    "present_load",
    "present_current",
    "present_voltage",
    "present_temperature",
    "hardware_error",
)
"""Registers that change by themselves."""
VOLTAGE, HEAT, OVERLOAD = "input voltage", "overheating", "overload"
"""Meanings of the error bits that it sets, if its family has them."""


class PlainServo(ByteServo):
    """One servo. Its registers have the driver's names and units, and one or two bytes.

    Its id and baud rate are at addresses below 14, where the bus looks for changes of them. It
    answers all instructions, with its errors in the error byte.

    Args:
        family: The driver's family.
        defaults: Factory defaults of registers, by name; the others are 0. Model number and P gain
            follow from the data sheet.
        model: Data sheet.
        shaft: The shaft that it drives.
        identifier: Bus id.
        baud: Baud rate.
        supply: Supply voltage, V.
        return_delay: Value of its return delay register; -1: the factory default.

    Raises:
        PluginError: It has a register that cannot be emulated.
    """

    def __init__(
        self,
        family: Family,
        defaults: Mapping[str, int],
        model: ServoModel,
        shaft: Shaft,
        identifier: int,
        baud: int,
        supply: float,
        return_delay: int = -1,
    ) -> None:
        self.family, self.bauds = family, {**family.bauds}
        self._registers = {**family.table(model.name)}
        self._gain = family.gain(model.name).register.name
        self._bits = {what: 1 << bit for bit, what in family.errors.items()}
        reported = [self._registers[name].address for name in REPORTED if name in self._registers]
        self.live, self.live_motion = min(reported), 0
        first = {"model_number": model.model_number, self._gain: model.p_default, **defaults}
        fields = [_field(register, first) for register in self._registers.values()]
        stored = [r.address + r.size for r in self._registers.values() if r.area == "eeprom"]
        table = ByteTable(fields, max(stored), self._registers["goal_position"].order == "big")
        loop = MotorLoop(model, shaft, supply, model.counts_per_rev / math.tau, model.middle)
        given = {"return_delay": return_delay} if return_delay >= 0 else {}
        known = {name: value for name, value in given.items() if name in self._registers}
        super().__init__(model.name, table, loop, identifier, baud, **known)

    @property
    def return_delay(self) -> float:
        """Delay from the end of an instruction to the status packet, s."""
        return self._value("return_delay", 0.0)

    @property
    def return_level(self) -> int:
        """Status return level: it answers all instructions."""
        return ANSWERS_ALL

    def init_registers(self) -> None:
        """Set the goal to the present position."""
        self.loop.sample()
        self._show("goal_position", self._counts())

    def check(self, address: int, data: bytes) -> tuple[int, Writes]:
        """Return the fields that a write sets: read-only ones are skipped, values are clamped."""
        writes, _ = self.table.decode(address, data)
        return 0, [(field, max(field.low, min(field.high, value))) for field, value in writes]

    def save_field(self, name: str) -> None:
        """Save a field, unless there is a lock and it is on."""
        if "lock" not in self._registers or not self.table.get("lock"):
            self.table.save(name)

    def apply_fields(self, names: set[str], now: float) -> None:
        """Apply the effects of fields that have been written together."""
        if "torque_enable" in names:
            on = bool(self.table.get("torque_enable"))
            if not on and not self.family.latching:
                self._flag(OVERLOAD, False)
            self._switch(on and not self._shut, now, "goal_position" in names)
        goal = "goal_position" in names and not self._shut
        if goal and (self.torque_on or self.family.goal_enables_torque):
            self._switch(True, now, True)
            servo = self.loop.servo
            end = min(self.table.get("goal_position"), servo.last_count)
            rate = servo.goal_speed * self.loop.per_rad
            self.loop.move(now, end, 0.0 if rate == math.inf else rate, 0.0)
        if self.torque_on:
            self._drive(now)

    def write_sample(self, now: float, motion: bool) -> None:
        """Write the last sample to the registers."""
        loop, driving = self.loop, self.driving
        values = (
            loop.velocity,
            loop.duty() if driving else 0.0,
            loop.amperes() if driving else 0.0,
            loop.supply,
            self.temperature,
            self.errors,
        )
        self._show(REPORTED[0], self._counts())
        for name, value in zip(REPORTED[1:], values, strict=True):
            if name in self._registers:
                self._show(name, value / self._registers[name].unit)

    def voltage_is_wrong(self) -> bool:
        """Return whether the supply is outside of the voltage limits."""
        limits = self.loop.servo.limits
        if limits is None:
            return False
        low = self._value("min_voltage_limit", limits.low)
        return not low <= self.loop.supply <= self._value("max_voltage_limit", limits.high)

    def protect(self, now: float, dt: float) -> None:
        """Set the error bits, and switch the torque off if the shutdown register demands it."""
        limits = self.loop.servo.limits
        hottest = self._value("temperature_limit", limits.temperature if limits else math.inf)
        self._flag(VOLTAGE, self.voltage_is_wrong())
        self._flag(HEAT, self.temperature >= hottest)
        strained = self.driving and self.loop.relative_torque() >= OVERLOAD_LEVEL
        self._strained = self._strained + dt if strained else 0.0
        if self._strained > OVERLOAD_TIME:
            self.overload(now)
        elif self._shut and self.torque_on:
            self._switch(False, now)

    def overload(self, now: float) -> None:
        """Enter the overload state."""
        self._flag(OVERLOAD, True)
        if self._shut and self.torque_on:
            self._switch(False, now)

    @property
    def _shut(self) -> bool:
        """Whether an error keeps the torque off."""
        return bool(self.errors & self.table.get(self.family.shutdown) & ~self.family.weakening)

    def _flag(self, what: str, on: bool) -> None:
        bit = self._bits.get(what, 0)
        self.errors = self.errors | bit if on else self.errors & ~bit

    def _value(self, name: str, default: float) -> float:
        """Return the value of a register in its SI unit; `default` if there is no such register."""
        register = self._registers.get(name)
        return default if register is None else self.table.get(name) * register.unit

    def _show(self, name: str, counts: float) -> None:
        """Set a register to the nearest value that it can have."""
        field = self.table.fields[name]
        low, high = _range(self._registers[name])
        self.table.set(field.name, max(low, min(high, round(counts))))

    def _counts(self) -> float:
        return max(0.0, min(self.loop.servo.last_count, self.loop.counts(self.loop.position)))

    def _switch(self, on: bool, now: float, has_goal: bool = False) -> None:
        """Switch the torque; without a goal, the present position becomes the goal."""
        was, self.torque_on = self.torque_on, on
        self.table.set("torque_enable", int(on))
        if not on:
            self.loop.release()
        elif not was:
            self.loop.hold_here()
            if not has_goal:
                self.init_registers()

    def _drive(self, now: float) -> None:
        """Set gain and limit of the loop, and command the shaft accordingly."""
        loop = self.loop
        loop.most = loop.servo.pwm_limit * self._value("torque_limit", 1.0)
        loop.gain = loop.servo.error_gain * self.table.get(self._gain)
        loop.update(now)


def _range(register: Register) -> tuple[int, int]:
    """Return the smallest and the largest value that a register can have."""
    if register.sign_bit is not None:
        return 1 - (1 << register.sign_bit), (1 << register.sign_bit) - 1
    bits = 8 * register.size
    return (-(1 << bits - 1), (1 << bits - 1) - 1) if register.signed else (0, (1 << bits) - 1)


def _field(register: Register, defaults: Mapping[str, int]) -> Field:
    """Return the field of the control table for a register of the driver.

    Raises:
        PluginError: The register is longer than two bytes, or is a signed byte.
    """
    if register.size > 2 or (register.signed and register.size == 1):
        raise PluginError(
            f"register {register.name!r}: a PlainServo has registers of one or two bytes, and no "
            "signed byte; write a windup.sim_twin.wire.device.Device for other servos"
        )
    low, high = _range(register)
    sign = TWOS if register.signed else register.sign_bit or 0
    access, default = "RW" if register.writable else "R", defaults.get(register.name, 0)
    name, address = register.name, register.address
    return Field(address, register.size, name, access, default, low, high, sign)
