"""The firmware of Feetech servos: effects of writes, time and faults.

According to the memory table, EEPROM registers (the id too) can be written while the lock is on,
but revert to their saved values at power-up. Writing a goal switches the torque on. Writing 128 to
the torque register makes the present position the middle, 2048, by setting the offset. Register 44
is the PWM of PWM mode, and on an STS nothing else: the tables of SMS and STS give it in 0.1 % and
for that mode, and a user who tried it as a time in position mode saw no effect (zeroth-bot pull
request 89). On an SCS it is a time in ms while the speed is 0 (its table).
"""

import math
import struct

from windup.hal.servos.servo_model import ServoModel
from windup.sim_twin.wire.servos.byte_servo import ByteServo, magnitude
from windup.sim_twin.wire.servos.byte_table import Writes
from windup.sim_twin.wire.servos.feetech_tables import (
    ACCELERATION_STEP,
    BAUDS,
    CURRENT_UNIT,
    SPEED_STEP,
    FeetechModel,
)
from windup.sim_twin.wire.servos.motor_loop import MotorLoop
from windup.sim_twin.wire.shafts.shaft import Shaft

# Bits of the status register, which is also the error byte.
VOLTAGE, ENCODER, TEMPERATURE, CURRENT, ANGLE, OVERLOAD = 0x01, 0x02, 0x04, 0x08, 0x10, 0x20

SET_MIDDLE = 128  # written to the torque register
FINE_SPEED, ZERO_IS_FASTEST, MANY_TURNS = 0x04, 0x08, 0x10  # bits of the phase register
POSITION, SPEED, PWM, STEP = 0, 1, 2, 3
FULL = 1000  # full scale of torque, load and PWM
PROTECTION_UNIT = 0.010  # s
TURN = 4096
FURTHEST = 32767  # counts
PWM_SIGN = 0x400
_STS_WORDS, _SCS_WORDS = struct.Struct("<HHH"), struct.Struct(">HHH")
_HEALTH, _CURRENT = struct.Struct("<5B"), struct.Struct("<H")
SLOW = 10  # steps/s; slower than this counts as standing still
GOALS = frozenset(("goal_position", "goal_speed", "goal_time"))
RETUNED = frozenset(("p_gain", "torque_limit", "max_torque", "mode", "phase", "max_speed"))
MOVED = frozenset(("offset", "phase", "mode"))


class FeetechServo(ByteServo):
    """An STS or SCS servo.

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
    live, live_motion = 56, 62
    min_voltage, max_voltage = "min_voltage", "max_voltage"

    def __init__(
        self,
        model: FeetechModel,
        servo: ServoModel,
        shaft: Shaft,
        identifier: int = 1,
        baud: int = 1_000_000,
        supply: float = 7.4,
        **registers: int,
    ) -> None:
        per_rad = servo.counts_per_rev / (2.0 * math.pi)
        self.magnetic = model.magnetic
        self._overcurrent = 0.0
        loop = MotorLoop(servo, shaft, supply, per_rad, servo.middle)
        super().__init__(model.name, model.table(), loop, identifier, baud, **registers)

    @property
    def return_level(self) -> int:
        """Status return level: 1 answers pings and reads, 2 all instructions."""
        return 1 + self.table.get("status_return_level")

    @property
    def mode(self) -> int:
        """Operating mode; an SCS has no register for it, and is a wheel if both limits are 0."""
        if self.magnetic:
            return self.table.get("mode")
        return PWM if self._free else POSITION

    @property
    def _free(self) -> bool:
        """Whether both angle limits are 0, which means no limits."""
        return self.table.get("min_angle") == self.table.get("max_angle") == 0

    @property
    def _offset(self) -> int:
        """The effective offset: nonzero in position mode only (STS_servos issue 9)."""
        return self.table.get("offset") if self.magnetic and self.mode == POSITION else 0

    @property
    def _many_turns(self) -> bool:
        return bool(self.table.get("phase") & MANY_TURNS)

    def init_registers(self) -> None:
        """Set the torque limit from the EEPROM, and the goal to the present position."""
        self._overcurrent = 0.0
        if self.magnetic:
            self.table.set("torque_limit", self.table.get("max_torque"))
        self.loop.sample()
        self.table.set("goal_position", self._shown_position())

    def check(self, address: int, data: bytes) -> tuple[int, Writes]:
        """Return the fields that a write sets: read-only ones are skipped, values are clamped."""
        writes, _ = self.table.decode(address, data)
        return 0, [(field, max(field.low, min(field.high, value))) for field, value in writes]

    def save_field(self, name: str) -> None:
        """Save a field, unless the lock is on."""
        if not self.table.get("lock"):
            self.table.save(name)

    def factory_reset(self, option: int, broadcast: bool, now: float) -> int:
        """Restore the factory values of all but the id, and reboot (FT-SCS protocol, 0x06)."""
        self.table.reset_to_factory(keep=("id",))
        self.reboot(now)
        return 0

    def apply_fields(self, names: set[str], now: float) -> None:
        """Apply the effects of fields that have been written together."""
        if "torque_enable" in names:
            self._write_torque(names, now)
        if "max_torque" in names and self.magnetic:
            self.table.set("torque_limit", self.table.get("max_torque"))
        if names & MOVED:
            self.loop.hold_here()
        follows = {SPEED: "goal_speed", PWM: "goal_time"}.get(self.mode, "goal_position")
        if follows in names and not self._shut:
            self._switch(True, now)
            self._go(now)
        elif names & (RETUNED | GOALS) and self.torque_on:
            self._drive(now)

    def write_sample(self, now: float, motion: bool) -> None:
        """Write the last sample to the registers; with `motion`, only position, speed, load."""
        loop, memory, driving = self.loop, self.table.memory, self.driving
        steps = loop.velocity * loop.per_rad
        load = loop.duty() * FULL if driving else 0.0
        position = magnitude(self._shown_position(), 15)
        speed = magnitude(steps / self._speed_unit, 15)
        words = _STS_WORDS if self.magnetic else _SCS_WORDS
        words.pack_into(memory, 56, position, speed, magnitude(load, 10))
        if motion:
            return
        volts, warmth = min(255, round(loop.supply * 10.0)), min(255, round(self.temperature))
        going = driving and (loop.moving(now) or abs(steps) > SLOW)
        kept = self._registered is not None
        _HEALTH.pack_into(memory, 62, volts, warmth, kept, self.errors, going)
        if self.magnetic:
            amperes = loop.amperes() if driving else 0.0
            _CURRENT.pack_into(memory, 69, magnitude(amperes / CURRENT_UNIT, 15))

    def protect(self, now: float, dt: float) -> None:
        """Set the status bits, and switch the torque off if Unloading Condition demands it."""
        get, loop = self.table.get, self.loop
        self._flag(VOLTAGE, self.voltage_is_wrong())
        self._flag(TEMPERATURE, self.temperature >= get("max_temperature"))
        most = get("torque_limit") / FULL if self.magnetic else get("max_torque") / FULL
        strained = self.driving and loop.relative_torque() >= get("overload_torque") / 100.0 * most
        self._strained = self._strained + dt if strained and most else 0.0
        if self._strained > get("protection_time") * PROTECTION_UNIT:
            self.overload(now)
        if self.magnetic:
            limit = get("protection_current") * CURRENT_UNIT
            over = self.driving and abs(loop.amperes()) > limit
            self._overcurrent = self._overcurrent + dt if over else 0.0
            if self._overcurrent > get("overcurrent_time") * PROTECTION_UNIT:
                self.errors |= CURRENT
        if self._shut and self.torque_on:
            self._switch(False, now)

    def overload(self, now: float) -> None:
        """Enter the overload state: limit the torque to Protective Torque until torque is off.

        No manual states what ends it. Users report that goals do not (lerobot's arms stay limited,
        open-edge-platform/physical-ai-studio issue 955), and that switching the torque off does.
        """
        self._strained = 0.0
        self.errors |= OVERLOAD
        if self.torque_on and OVERLOAD & self.table.get("unloading_condition"):
            self._drive(now)

    @property
    def _shut(self) -> bool:
        """Whether Unloading Condition keeps the torque off because of a present error."""
        return bool(self.errors & ~OVERLOAD & self.table.get("unloading_condition"))

    @property
    def _speed_unit(self) -> int:
        """Unit of the speed registers, steps/s."""
        fine = not self.magnetic or self.table.get("phase") & FINE_SPEED
        return 1 if fine else SPEED_STEP

    def _flag(self, bit: int, on: bool) -> None:
        self.errors = self.errors | bit if on else self.errors & ~bit

    def _shown_position(self) -> int:
        counts = round(self.loop.counts(self.loop.position)) - self._offset
        if not self.magnetic:
            return max(0, min(1023, counts))
        if self._many_turns or self.mode == STEP:
            return max(-FURTHEST, min(FURTHEST, counts))
        return counts % TURN

    def _write_torque(self, names: set[str], now: float) -> None:
        """Switch the torque, or make the present position the middle."""
        value = self.table.get("torque_enable")
        if value == SET_MIDDLE and self.magnetic:
            self.loop.sample()
            raw = round(self.loop.counts(self.loop.position)) % TURN
            self.table.set("offset", max(-2047, min(2047, raw - TURN // 2)))
            self.table.save("offset")
            self.loop.hold_here()
            self.table.set("torque_enable", int(self.torque_on))
        else:
            if not value:
                self.errors &= ~(OVERLOAD | CURRENT)
            self._switch(value > 0 and not self._shut, now)
            if value and "goal_position" not in names:
                self.loop.sample()
                self.table.set("goal_position", self._shown_position())

    def _switch(self, on: bool, now: float) -> None:
        """Switch the torque; when on, the goal becomes the present position (assumed)."""
        was, self.torque_on = self.torque_on, on
        self.table.set("torque_enable", int(on))
        if on and not was:
            self.loop.hold_here()
            self._drive(now)
        elif not on:
            self.loop.release()

    def _go(self, now: float) -> None:
        """Start moving to the goals, according to the mode."""
        get, loop, mode = self.table.get, self.loop, self.mode
        speed = get("goal_speed") * self._speed_unit
        rise = float(get("acceleration"))
        if self.magnetic:
            rise = (rise or get("max_acceleration")) * ACCELERATION_STEP
        if mode == SPEED:
            fastest = self._fastest()
            loop.run(now, max(-fastest, min(fastest, speed)), rise)
        elif mode in (POSITION, STEP):
            goal = self._goal_counts(now)
            seconds = 0 if self.magnetic or speed else get("goal_time")
            if seconds:
                loop.move_in(now, goal, seconds * 1e-3)
            elif speed or get("phase") & ZERO_IS_FASTEST or not self.magnetic:
                rate = min(abs(speed) or math.inf, self._fastest())
                loop.move(now, goal, 0.0 if rate == math.inf else rate, rise)
        self._drive(now)

    def _fastest(self) -> float:
        """Return the speed limit of the goal, steps/s; infinity if there is none."""
        top = self.table.get("max_speed") * SPEED_STEP if self.magnetic else 0
        return float(top) if top else math.inf

    def _goal_counts(self, now: float) -> float:
        """Return the goal in the loop's counts."""
        goal = self.table.get("goal_position")
        if self.mode == STEP:
            return self.loop.goal(now)[0] + goal
        if not self._free:
            goal = max(self.table.get("min_angle"), min(self.table.get("max_angle"), goal))
        if self.magnetic and not self._many_turns and 0 <= goal < TURN:
            turns = math.floor((self.loop.counts(self.loop.shaft.position) - self._offset) / TURN)
            goal += turns * TURN
        return float(goal + self._offset)

    def _drive(self, now: float) -> None:
        """Set gain and limits of the loop, and command the shaft accordingly."""
        get, loop = self.table.get, self.loop
        most = float(get("torque_limit") if self.magnetic else get("max_torque"))
        if self.errors & OVERLOAD & get("unloading_condition"):
            most *= get("protective_torque") / 100.0
        loop.most = most / FULL * loop.servo.pwm_limit
        loop.gain = loop.servo.error_gain * get("p_gain")
        if self.mode == PWM:
            duty = get("goal_time")
            if not self.magnetic:
                duty = -(duty & ~PWM_SIGN) if duty & PWM_SIGN else duty
            loop.apply_duty(duty / FULL)
        else:
            loop.update(now)
