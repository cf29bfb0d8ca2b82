"""One method for each kind of event of servos, supply, adapter, IMU or board."""

from abc import ABC, abstractmethod
from typing import Self, Unpack

from windup.sim_twin.wire.faults.fault_keywords import TargetKeywords, TimeKeywords
from windup.sim_twin.wire.faults.fault_rule import FaultRule, make_rule


class EventMethods(ABC):
    """Adds events of servos, supply, adapter, IMU or board.

    Each method adds one event and returns the object, so that calls can be chained. All take the
    keywords of `TargetKeywords`. Without ``rate`` and ``at`` an event happens once, at the
    present time: the next wait or use of a port executes it.
    """

    @property
    @abstractmethod
    def now(self) -> float:
        """The present time, s."""

    @abstractmethod
    def add(self, rule: FaultRule) -> Self:
        """Add a fault."""

    def dead(self, **who: Unpack[TargetKeywords]) -> Self:
        """Break servos permanently: they do not answer and have no torque."""
        return self.add(make_rule("dead", **self._when(who)))

    def reset(self, **who: Unpack[TargetKeywords]) -> Self:
        """Restart servos: torque off, RAM registers as after power-up."""
        return self.add(make_rule("reset", **self._when(who)))

    def overload(self, **who: Unpack[TargetKeywords]) -> Self:
        """Trigger the overload protection of servos, as a blocked horn does.

        With factory settings a Dynamixel X sets bit 5 of Hardware Error Status (70) and the alert
        bit of its answers, and switches torque off until it is rebooted. A Dynamixel servo of
        protocol 1 sets bit 5 of the error byte of its answers and switches torque off; a Feetech
        servo sets the same bit and limits its torque to Protective Torque.
        """
        return self.add(make_rule("overload", **self._when(who)))

    def heat(
        self, degrees: float = 75.0, seconds: float | None = None, **who: Unpack[TargetKeywords]
    ) -> Self:
        """Heat motors at once, and keep them from cooling.

        Args:
            degrees: Lowest motor temperature, degrees C, up to 255.
            seconds: Duration, s; for ever by default.
            **who: See `TargetKeywords`.
        """
        return self.add(make_rule("heat", degrees=degrees, seconds=seconds, **self._when(who)))

    def brown_out(
        self, volts: float = 0.0, seconds: float | None = None, **when: Unpack[TimeKeywords]
    ) -> Self:
        """Lower the supply voltage of all devices for some time.

        Args:
            volts: Supply voltage meanwhile, V.
            seconds: Duration, s; 0.1 by default.
            **when: See `TimeKeywords`.
        """
        return self.add(make_rule("brown_out", volts=volts, seconds=seconds, **self._when(when)))

    def unplug(self, seconds: float | None = None, **when: Unpack[TimeKeywords]) -> Self:
        """Unplug the adapter: open ports fail, and can be reopened once it is plugged in again.

        Args:
            seconds: Time until it is plugged in again, s; 0.5 by default, `math.inf`: never.
            **when: See `TimeKeywords`.
        """
        return self.add(make_rule("unplug", seconds=seconds, **self._when(when)))

    def imu_silent(self, seconds: float | None = None, **who: Unpack[TargetKeywords]) -> Self:
        """Silence the IMU, and the board that it is on.

        Args:
            seconds: Duration, s; for ever by default.
            **who: See `TargetKeywords`.
        """
        return self.add(make_rule("imu_silent", seconds=seconds, **self._when(who)))

    def imu_frozen(self, seconds: float | None = None, **who: Unpack[TargetKeywords]) -> Self:
        """Freeze the IMU: it repeats one sample.

        Args:
            seconds: Duration, s; for ever by default.
            **who: See `TargetKeywords`.
        """
        return self.add(make_rule("imu_frozen", seconds=seconds, **self._when(who)))

    def imu_spin(
        self, speed: float = 3.0, seconds: float | None = None, **who: Unpack[TargetKeywords]
    ) -> Self:
        """Make the gyroscope report a constant rate about x.

        Args:
            speed: Reported rate, rad/s.
            seconds: Duration, s; for ever by default.
            **who: See `TargetKeywords`.
        """
        return self.add(make_rule("imu_spin", speed=speed, seconds=seconds, **self._when(who)))

    def button(self, seconds: float | None = None, **when: Unpack[TimeKeywords]) -> Self:
        """Press the user button of an OpenCR.

        Args:
            seconds: Duration, s; 0.2 by default.
            **when: See `TimeKeywords`.
        """
        return self.add(make_rule("button", seconds=seconds, **self._when(when)))

    def _when(self, given: TargetKeywords | TimeKeywords) -> TargetKeywords:
        """Return the keywords of an event; the time is now if neither rate nor time is given."""
        keywords = TargetKeywords(**given)
        if "rate" not in keywords and "at" not in keywords:
            keywords["at"] = self.now
        return keywords
