"""The firmware of AX and MX servos with protocol 1: effects of writes, time and faults.

Joint mode, wheel mode (both angle limits 0), on an MX also multi-turn (both 4095) and, with a
current sensor, torque control. Writing a goal switches the torque on. After an alarm shutdown the
torque limit is 0, and the servo does not move until a host has written another limit.
"""

import math
import struct
from typing import Final

from windup.hal.servos.servo_model import ServoModel
from windup.sim_twin.wire.servos.byte_servo import ByteServo, magnitude
from windup.sim_twin.wire.servos.byte_table import Writes
from windup.sim_twin.wire.servos.dynamixel1_tables import (
    ACCELERATION_UNIT,
    BAUDS,
    CURRENT_UNIT,
    CURRENT_ZERO,
    EEPROM_END,
    Dynamixel1Model,
)
from windup.sim_twin.wire.servos.health import OVERLOAD_LEVEL, OVERLOAD_TIME
from windup.sim_twin.wire.servos.motor_loop import MotorLoop
from windup.sim_twin.wire.shafts.shaft import Shaft

# Bits of the error byte.
INPUT_VOLTAGE, ANGLE_LIMIT, OVERHEATING, RANGE = 0x01, 0x02, 0x04, 0x08
CHECKSUM, OVERLOAD, INSTRUCTION = 0x10, 0x20, 0x40

FULL: Final = 1023  # full scale of torque limits, loads and wheel speeds
SLOPES: Final = (2, 4, 8, 16, 32, 64, 128)  # compliance slopes of an AX, counts
GAINS = frozenset(
    ("p_gain", "cw_compliance_slope", "ccw_compliance_slope", "torque_limit", "cw_angle_limit",
     "ccw_angle_limit", "torque_control_mode", "goal_torque", "goal_acceleration")
)  # fmt: skip
_MOTION, _HEALTH, _WORD = struct.Struct("<HHH"), struct.Struct("<5B"), struct.Struct("<H")
SLOW = 2  # units of speed; slower than this counts as standing still


class Dynamixel1Servo(ByteServo):
    """An AX or MX servo.

    Args:
        model: Description of its control table.
        servo: Data sheet.
        shaft: The shaft that it drives.
        identifier: Bus id.
        baud: Baud rate.
        supply: Supply voltage, V.
        **registers: Other registers that differ from the factory defaults, by name.
    """

    bauds = BAUDS
    live, live_motion = 36, 42
    min_voltage, max_voltage = "min_voltage_limit", "max_voltage_limit"

    def __init__(
        self,
        model: Dynamixel1Model,
        servo: ServoModel,
        shaft: Shaft,
        identifier: int = 1,
        baud: int = 1_000_000,
        supply: float = 12.0,
        **registers: int,
    ) -> None:
        per_rad = servo.counts_per_rev / (2.0 * math.pi)
        loop = MotorLoop(servo, shaft, supply, per_rad, servo.middle)
        self._unit = model.speed_unit
        super().__init__(model.name, model.table(), loop, identifier, baud, **registers)

    @property
    def return_level(self) -> int:
        """Status return level: 0 answers pings, 1 also reads, 2 all instructions."""
        return self.table.get("status_return_level")

    @property
    def _is_ax(self) -> bool:
        return "cw_compliance_slope" in self.table.fields

    @property
    def _limits(self) -> tuple[int, int]:
        return self.table.get("cw_angle_limit"), self.table.get("ccw_angle_limit")

    @property
    def _wheel(self) -> bool:
        return self._limits == (0, 0)

    @property
    def _many_turns(self) -> bool:
        return not self._is_ax and self._limits == (4095, 4095)

    @property
    def _divider(self) -> int:
        return self.table.get("resolution_divider") if self._many_turns else 1

    def init_registers(self) -> None:
        """Set the torque limit from the EEPROM, and the goal to the present position."""
        self.table.set("torque_limit", self.table.get("max_torque"))
        self.loop.sample()
        self.table.set("goal_position", self._shown_position())

    def check(self, address: int, data: bytes) -> tuple[int, Writes]:
        """Return the error of a write, and the fields that it would set: all or none."""
        writes, clean = self.table.decode(address, data)
        if not clean:
            return RANGE, []
        for field, value in writes:
            if not field.low <= value <= field.high:
                return RANGE, []
            if field.address < EEPROM_END and self.table.get("lock"):
                return RANGE, []
            if field.name == "goal_position" and not self._within_limits(value):
                return ANGLE_LIMIT, []
            if field.name == "lock" and not value and self.table.get("lock"):
                return RANGE, []  # only a power cycle unlocks
        return 0, writes

    def save_field(self, name: str) -> None:
        """Save a field: EEPROM registers are stored immediately."""
        self.table.save(name)

    def apply_fields(self, names: set[str], now: float) -> None:
        """Apply the effects of fields that have been written together."""
        if "max_torque" in names:
            self.table.set("torque_limit", self.table.get("max_torque"))
        if "torque_limit" in names and self.table.get("torque_limit"):
            self.errors &= ~OVERLOAD
        if "torque_enable" in names:
            self._switch(bool(self.table.get("torque_enable")), now)
        if "goal_position" in names and not self._wheel:
            self._switch(True, now)
            self._go(now)
        elif "moving_speed" in names and self.torque_on:
            self._go(now)
        elif names & GAINS and self.torque_on:
            self._drive(now)

    def write_sample(self, now: float, motion: bool) -> None:
        """Write the last sample to the registers; with `motion`, only position, speed, load."""
        loop, memory = self.loop, self.table.memory
        speed, driving = loop.velocity / self._unit, self.driving
        load = loop.duty() * FULL if driving else 0.0
        position = self._shown_position() & 0xFFFF
        _MOTION.pack_into(memory, 36, position, magnitude(speed, 10), magnitude(load, 10))
        if motion:
            return
        volts, warmth = min(255, round(loop.supply * 10.0)), min(255, round(self.temperature))
        going = driving and (loop.moving(now) or abs(speed) > SLOW)
        _HEALTH.pack_into(memory, 42, volts, warmth, self._registered is not None, 0, going)
        if not self._is_ax:
            _WORD.pack_into(memory, 50, int(now * 1e3) & 0x7FFF)
        if "current" in self.table.fields:
            units = round(loop.amperes() / CURRENT_UNIT) if driving else 0
            _WORD.pack_into(memory, 68, max(0, min(4095, CURRENT_ZERO + units)))

    def protect(self, now: float, dt: float) -> None:
        """Set the error bits, and switch the torque off if Alarm Shutdown demands it."""
        hot = self.temperature >= self.table.get("temperature_limit")
        self._flag(INPUT_VOLTAGE, self.voltage_is_wrong())
        self._flag(OVERHEATING, hot)
        strained = self.driving and self.loop.relative_torque() >= OVERLOAD_LEVEL
        self._strained = self._strained + dt if strained else 0.0
        if self._strained > OVERLOAD_TIME:
            self.errors |= OVERLOAD
        if self.errors & self.table.get("shutdown") and self.torque_on:
            self._shut_down(now)

    def overload(self, now: float) -> None:
        """Enter the overload state."""
        self.errors |= OVERLOAD
        if OVERLOAD & self.table.get("shutdown"):
            self._shut_down(now)

    def _shut_down(self, now: float) -> None:
        self.table.set("torque_limit", 0)
        self._switch(False, now)

    def _flag(self, bit: int, on: bool) -> None:
        self.errors = self.errors | bit if on else self.errors & ~bit

    def _within_limits(self, goal: int) -> bool:
        low, high = self._limits
        return self._wheel or self._many_turns or low <= goal <= high

    def _shown_position(self) -> int:
        counts = round(self.loop.counts(self.loop.position))
        if self._many_turns:
            return counts // self._divider + self.table.get("multi_turn_offset")
        return max(0, min(FULL, counts)) if self._is_ax else counts % 4096

    def _switch(self, on: bool, now: float) -> None:
        """Switch the torque; when on, the servo moves to the goal register's value, however old."""
        was, self.torque_on = self.torque_on, on
        self.table.set("torque_enable", int(on))
        if on and not was:
            self.loop.hold_here()
            self._go(now)
        elif not on:
            self.loop.release()

    def _go(self, now: float) -> None:
        """Move to the goal position at the moving speed, or run, according to the mode."""
        get, loop = self.table.get, self.loop
        speed = get("moving_speed")
        rise = 0.0
        if not self._is_ax:
            rise = get("goal_acceleration") * ACCELERATION_UNIT * loop.per_rad
        if not self._wheel:
            goal = get("goal_position")
            if self._many_turns:
                goal = (goal - get("multi_turn_offset")) * self._divider
            rate = (speed & FULL) * self._unit * loop.per_rad
            loop.move(now, goal, rate, rise if rate else 0.0)
        elif not self._is_ax:
            signed = -(speed & FULL) if speed > FULL else speed
            loop.run(now, signed * self._unit * loop.per_rad, rise)
        self._drive(now)

    def _drive(self, now: float) -> None:
        """Set gain and limits of the loop, and command the shaft accordingly."""
        get, loop = self.table.get, self.loop
        loop.most = get("torque_limit") / FULL * loop.servo.pwm_limit
        if self._is_ax:
            slope = max(s for s in SLOPES if s <= max(2, get("cw_compliance_slope")))
            loop.gain = loop.per_rad / slope
        else:
            loop.gain = loop.servo.error_gain * get("p_gain")
        if "goal_torque" in self.table.fields and get("torque_control_mode"):
            goal = get("goal_torque")
            amperes = (-(goal & FULL) if goal > FULL else goal) * CURRENT_UNIT
            constant = loop.servo.torque_constant or 0.0
            loop.shaft.apply_torque(amperes * constant, loop.most * loop.supply)
        elif self._wheel and self._is_ax:
            speed = get("moving_speed")
            loop.apply_duty((-(speed & FULL) if speed > FULL else speed) / FULL)
        else:
            loop.update(now)
