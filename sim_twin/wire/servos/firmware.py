"""The firmware of an X-series servo: effects of writes, time and faults."""

from windup.hal.servos.servo_model import ServoModel
from windup.sim_twin.wire.servos.backup import Backup
from windup.sim_twin.wire.servos.control_loop import POSITION_MODES, ControlLoop
from windup.sim_twin.wire.servos.health import Health
from windup.sim_twin.wire.servos.present_registers import PresentRegisters
from windup.sim_twin.wire.servos.register_file import (
    BAD_ACCESS,
    BAD_LIMIT,
    BAD_RANGE,
    OK,
    TableItem,
)
from windup.sim_twin.wire.servos.x_series import (
    CURRENT,
    POSITION,
    PWM,
    VELOCITY,
    WATCHDOG_UNIT,
    XSeriesModel,
)
from windup.sim_twin.wire.shafts.shaft import Shaft

ALERT = 0x80  # bit of a status packet's error byte: Hardware Error Status is not 0
TORQUE_BY_GOAL = 0x08  # bit of the drive mode
TRIPPED = 0xFF  # bus watchdog register after it has tripped: -1
REMOTE = 20  # first protocol type for a remote control, which X330 servos have
STARTUP_TORQUE, STARTUP_RESTORE = 0x01, 0x02  # bits of the startup configuration
GOAL_LIMITS = {
    "goal_pwm": "pwm_limit",
    "goal_current": "current_limit",
    "goal_velocity": "velocity_limit",
}
OPEN_LOOP = {CURRENT: "goal_current", PWM: "goal_pwm"}  # modes without a loop, with their goals
GOALS = frozenset((*GOAL_LIMITS, "goal_position"))
RETUNE = frozenset(("position_p_gain", "pwm_limit", "velocity_i_gain", "velocity_p_gain"))
MODE_DEFAULTS = range(76, 120)  # addresses of the RAM that a change of mode resets
KEPT = frozenset(("bus_watchdog",))


class Firmware:
    """Implements the registers of one servo, and drives its shaft accordingly.

    Attributes:
        registers: The control table.
        loop: The control loop.
        present: The sample of the shaft that reads report.
        health: Hardware errors.
        backup: The registers that Control Table Backup has stored.
        powered: Whether there is a supply voltage.
        stopped: Whether the bus watchdog has switched the output off, in current or PWM mode; a new
            goal ends that, once the watchdog register has been cleared.
    """

    def __init__(self, model: XSeriesModel, servo: ServoModel, shaft: Shaft, supply: float) -> None:
        self.model = model
        self.registers = model.registers()
        self.loop = ControlLoop(model, servo, self.registers, shaft, supply)
        self.present = PresentRegisters(self.loop)
        self.health = Health(self.loop)
        self.backup = Backup(self.registers)
        self.powered = True
        self.stopped = False
        self._on = False  # torque enable, as applied last

    @property
    def torque_on(self) -> bool:
        """Whether torque is enabled."""
        return bool(self.registers.memory[64])

    @property
    def driving(self) -> bool:
        """Whether the motor is driven, also while the tripped watchdog holds or brakes it."""
        return self.torque_on and not self.stopped and self.powered

    @property
    def alert(self) -> int:
        """The alert bit of the error byte."""
        return ALERT if self.health.errors else 0

    @property
    def _shut(self) -> bool:
        return bool(self.health.errors & self.registers.get("shutdown"))

    def restart(self, now: float) -> None:
        """Boot: reset RAM and errors, torque off, turns forgotten."""
        self.registers.reset(self.registers.ram())
        self.health.reset()
        self.stopped = self._on = False
        self.present.booted = now
        self.loop.release()
        self._change_mode()
        startup = 0
        if "startup_configuration" in self.registers.items:
            startup = self.registers.get("startup_configuration")
        self.backup.boot(restore=bool(startup & STARTUP_RESTORE))
        if startup & STARTUP_TORQUE:
            self._switch(True, now)

    def hold_here(self, forget: bool = False) -> None:
        """Make the present position the goal; with `forget`, also forget the counted turns.

        The e-Manual, Present Position(132): the turns are forgotten at power-up, when the mode
        changes, and in position mode when torque is switched on; never merely by motion.
        """
        loop = self.loop
        loop.encoder.load(self.registers)
        self.present.sample()
        if forget:
            loop.encoder.forget_turns(self.present.position)
        if loop.mode == VELOCITY:
            self.registers.set("goal_velocity", 0)
            loop.start_at(0.0)
            return
        counts = self.present.counts
        if loop.mode in POSITION_MODES:
            self.registers.set("goal_position", counts)
        loop.start_at(counts)

    def control(self, now: float, dt: float) -> None:
        """Run one step of the control loop; needed while `busy`."""
        if self.driving:
            self.loop.update(now, dt)

    def watch(self, now: float, dt: float, last_instruction: float) -> None:
        """Check watchdog and health, periodically; `last_instruction` is a time, s."""
        if not self.powered:
            return
        timeout = self.registers.memory[98]
        if 0 < timeout < 128 and self.driving and now - last_instruction > timeout * WATCHDOG_UNIT:
            self._trip(now)
        before = self.health.errors
        self.health.watch(dt, self.loop.shaft.torque, self.driving)
        if self.health.errors != before:
            self.protect(now)

    def _trip(self, now: float) -> None:
        """Trip the bus watchdog: hold here, brake, or, in a mode without a loop, release.

        The motor stays on in position and velocity mode. The manual, Bus Watchdog(98), only states
        that the servo stops (without a profile) and that goals are refused; the behaviour in each
        mode is from crane_x7_ros pull request 11 and DynamixelSDK issue 584.
        """
        self.registers.set("bus_watchdog", -1)
        for name in ("profile_acceleration", "profile_velocity"):
            self.registers.set(name, 0)
        freed = OPEN_LOOP.get(self.loop.mode)
        if freed is None:
            self.hold_here()
            self.loop.update(now)
            return
        self.registers.set(freed, 0)
        self.stopped = True
        self.loop.release()

    def protect(self, now: float) -> None:
        """Set the hardware error register, and switch the torque off if Shutdown demands it."""
        self.registers.set("hardware_error_status", self.health.errors)
        if self._shut and self.torque_on:
            self._switch(False, now)

    def set_supply(self, volts: float, now: float) -> None:
        """Change the supply voltage, V; at 0 V the servo is off, and boots when powered again."""
        was, self.powered = self.powered, volts > 0.0
        self.loop.supply = volts
        if self.powered and not was:
            self.restart(now)
        elif not self.powered:
            self.loop.release()
        elif self.driving:
            self.loop.update(now)

    def check_writes(self, writes: list[tuple[TableItem, int]]) -> int:
        """Return the error of a write whose values other registers forbid, or OK."""
        for item, value in writes:
            error = self._forbidden(item.name, value)
            if error:
                return error
        new = {item.name: value for item, value in writes}
        low = new.get("min_position_limit", 0)
        high = new.get("max_position_limit", 4095)
        return BAD_LIMIT if low > high else OK

    def _forbidden(self, name: str, value: int) -> int:
        get = self.registers.get
        if name in GOALS:
            if self.registers.memory[98] == TRIPPED:
                return BAD_RANGE
            if name != "goal_position":
                return OK if abs(value) <= get(GOAL_LIMITS[name]) else BAD_LIMIT
            if self.loop.mode != POSITION:
                return OK
            inside = get("min_position_limit") <= value <= get("max_position_limit")
            return OK if inside else BAD_LIMIT
        if name == "operating_mode" and value not in self.model.modes:
            return BAD_RANGE
        if name == "protocol_type" and 2 < value < REMOTE:
            return BAD_RANGE
        if name == "bus_watchdog" and (value < 0 or (value > 0 and get(name) < 0)):
            return BAD_RANGE
        if name == "torque_enable" and value and self._shut:
            return BAD_ACCESS
        return OK

    def apply_write(self, name: str, value: int, now: float) -> None:
        """Apply the effect of one register that has just been written."""
        if name in GOALS:
            self._new_goal(name, value, now)
        elif name == "torque_enable":
            self._switch(bool(value), now)
        elif name == "operating_mode" and value != self.loop.mode:
            self._change_mode()
        elif name in ("drive_mode", "homing_offset"):
            self.hold_here(forget=name == "drive_mode" and self.loop.mode == POSITION)
        elif name in RETUNE and self.driving:
            self.loop.update(now)

    def _new_goal(self, name: str, value: int, now: float) -> None:
        if not self.torque_on and self.registers.get("drive_mode") & TORQUE_BY_GOAL:
            self._switch(True, now)
            self.registers.set(name, value)
        if self.stopped:  # by the watchdog, whose register has been cleared since
            self.stopped = False
            self.hold_here()
            self.registers.set(name, value)
        if self.torque_on:
            follows = "goal_velocity" if self.loop.mode == VELOCITY else "goal_position"
            if name == follows:
                self.loop.plan(now)
            self.loop.update(now)

    def _switch(self, on: bool, now: float) -> None:
        """Switch the torque; when on, the goal becomes the present position."""
        same = on and self._on and (not self.stopped or self.registers.memory[98] == TRIPPED)
        self._on = on
        self.registers.set("torque_enable", int(on))
        if same:
            return
        self.stopped = False
        self.hold_here(forget=on and self.loop.mode == POSITION)
        if on:
            self.loop.update(now)
        else:
            self.loop.release()

    def _change_mode(self) -> None:
        """Reset gains and goals to the defaults of the mode, and forget the turns.

        The e-Manual, Operating Mode(11), makes no exception for the modes in which Goal PWM or Goal
        Current is the goal: there the motor runs as soon as torque is switched on, unless the host
        has written a goal before.
        """
        registers, mode = self.registers, self.registers.get("operating_mode")
        registers.reset(
            item
            for item in registers.ram()
            if item.address in MODE_DEFAULTS and item.name not in KEPT
        )
        self.loop.mode = mode
        registers.set("goal_pwm", registers.get("pwm_limit"))
        if self.model.current_unit is not None:
            registers.set("goal_current", registers.get("current_limit"))
        self.hold_here(forget=True)
