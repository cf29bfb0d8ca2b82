"""The registers that change by themselves, 120 to 146: the present state of the shaft."""

import struct

from windup.sim_twin.wire.servos.control_loop import POSITION_MODES, ControlLoop
from windup.sim_twin.wire.servos.x_series import PRESENT, PWM_FULL, VELOCITY, VELOCITY_UNIT

IN_POSITION, IN_PROGRESS, NOT_FOLLOWING = 0x01, 0x02, 0x08  # bits of Moving Status
TICKS = 0x7FFF  # largest value of Realtime Tick, ms, after which it restarts at 0
CLOSE = 20  # counts; a smaller error counts as arrived

_MOTION = struct.Struct("<hii")  # at 126: current or load, velocity, position
_BEFORE = struct.Struct("<HBBh")  # at 120: tick, moving, moving status, PWM
_BEHIND = struct.Struct("<iiHB")  # at 136: trajectories, voltage, temperature
MOTION = range(126, 136)


class PresentRegisters:
    """Samples a shaft, and writes the sample into the registers when they are read.

    Attributes:
        booted: Time at which the servo booted, s; Realtime Tick counts from there.
    """

    def __init__(self, loop: ControlLoop) -> None:
        self.loop, self.booted = loop, 0.0
        self.position = self.velocity = self.torque = 0.0

    def sample(self) -> None:
        """Sample position, velocity and torque of the shaft."""
        shaft = self.loop.shaft
        self.position, self.velocity, self.torque = shaft.position, shaft.velocity, shaft.torque

    @property
    def counts(self) -> int:
        """Present position, counts."""
        return self.loop.encoder.counts(self.position)

    @property
    def moving(self) -> bool:
        """Whether the shaft is faster than the moving threshold."""
        threshold = self.loop.registers.get("moving_threshold") * VELOCITY_UNIT
        return abs(self.velocity) > threshold

    def write(self, now: float, driving: bool, temperature: float, motion: bool) -> None:
        """Write the last sample into the registers; with `motion`, only into 126 to 135."""
        loop = self.loop
        memory, sign, counts = loop.registers.memory, loop.encoder.sign, self.counts
        speed = round(sign * self.velocity / VELOCITY_UNIT)
        _MOTION.pack_into(memory, MOTION.start, self._effort(driving), speed, counts)
        if motion:
            return
        trajectory, rate = loop.trajectory(now)
        going = driving and loop.mode != VELOCITY and loop.in_progress(now)
        status = self._status(counts, trajectory, now) if driving else 0
        tick, pwm = int((now - self.booted) * 1e3) & TICKS, self._pwm(driving)
        _BEFORE.pack_into(memory, PRESENT[0], tick, self.moving or going, status, pwm)
        volts, warmth = round(loop.supply * 10.0), max(0, min(255, round(temperature)))
        _BEHIND.pack_into(memory, MOTION.stop, round(rate), round(trajectory), volts, warmth)

    def _pwm(self, driving: bool) -> int:
        """Return the PWM that yields the present torque at the present speed."""
        loop = self.loop
        if not driving or loop.supply <= 0.0:
            return 0
        volts = self.torque * loop.resistance / loop.constant + loop.constant * self.velocity
        duty = max(-1.0, min(1.0, volts / loop.supply))
        return round(loop.encoder.sign * duty * PWM_FULL)

    def _effort(self, driving: bool) -> int:
        """Return register 126: the current, or, without a sensor, the load from the PWM."""
        unit = self.loop.torque_unit
        if unit is None:
            return round(self._pwm(driving) * 1000 / PWM_FULL)
        return max(-32768, min(32767, round(self.loop.encoder.sign * self.torque / unit)))

    def _status(self, counts: int, trajectory: float, now: float) -> int:
        loop = self.loop
        if loop.mode not in POSITION_MODES:
            return 0
        status = loop.profile.kind << 4
        status |= IN_POSITION if abs(counts - loop.profile.goal) < CLOSE else 0
        status |= IN_PROGRESS if loop.in_progress(now) else 0
        return status | (NOT_FOLLOWING if abs(counts - trajectory) > CLOSE else 0)
