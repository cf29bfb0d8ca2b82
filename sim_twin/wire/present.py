"""The registers that change by themselves, 120 to 146: what a servo says about its shaft."""

import struct

from sim_twin.wire.control_loop import POSITION_MODES, ControlLoop
from sim_twin.wire.x_series import PRESENT, PWM_FULL, VELOCITY, VELOCITY_UNIT

IN_POSITION, IN_PROGRESS, NOT_FOLLOWING = 0x01, 0x02, 0x08  # bits of Moving Status
CLOSE = 20  # counts; nearer than this counts as arrived

# tick, moving, moving status, PWM, current or load, velocity, position, trajectories, V, deg C
_LAYOUT = struct.Struct("<HBBhhiiiiHB")


class Present:
    """Samples a shaft, and writes the sample into the registers when somebody reads them."""

    def __init__(self, loop: ControlLoop) -> None:
        self.loop = loop
        self.position = self.velocity = self.torque = 0.0

    def sample(self) -> None:
        """Look at the shaft now."""
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

    def write(self, now: float, driving: bool, temperature: float) -> None:
        """Write the last sample into the registers."""
        loop, velocity = self.loop, self.velocity
        sign, counts = loop.encoder.sign, self.counts
        trajectory, speed = loop.trajectory(now)
        pwm = round(sign * self._duty() * PWM_FULL) if driving else 0
        going = driving and loop.mode != VELOCITY and loop.in_progress(now)
        _LAYOUT.pack_into(
            loop.registers.memory,
            PRESENT[0],
            int(now * 1e3) & 0x7FFF,
            self.moving or going,
            self._status(counts, trajectory, now) if driving else 0,
            pwm,
            self._effort(sign, pwm),
            round(sign * velocity / VELOCITY_UNIT),
            counts,
            round(speed),
            round(trajectory),
            round(loop.supply * 10.0),
            max(0, min(255, round(temperature))),
        )

    def _duty(self) -> float:
        """Return the duty that makes the present torque at the present speed."""
        motor, supply = self.loop.motor, self.loop.supply
        if supply <= 0.0:
            return 0.0
        volts = self.torque * motor.R / motor.K + motor.K * self.velocity
        return max(-1.0, min(1.0, volts / supply))

    def _effort(self, sign: float, pwm: int) -> int:
        """Return register 126: current, or where none is sensed the load, from the PWM."""
        unit = self.loop.torque_unit
        if unit is None:
            return round(pwm * 1000 / PWM_FULL)
        return max(-32768, min(32767, round(sign * self.torque / unit)))

    def _status(self, counts: int, trajectory: float, now: float) -> int:
        loop = self.loop
        if loop.mode not in POSITION_MODES:
            return 0
        status = loop.profile.kind << 4
        status |= IN_POSITION if abs(counts - loop.profile.goal) < CLOSE else 0
        status |= IN_PROGRESS if loop.in_progress(now) else 0
        return status | (NOT_FOLLOWING if abs(counts - trajectory) > CLOSE else 0)
