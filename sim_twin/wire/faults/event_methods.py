"""One method for each kind of event: what befalls servos, supply, adapter, IMU or board."""

from abc import ABC, abstractmethod
from typing import Self, Unpack

from windup.sim_twin.wire.faults.fault_keywords import When, Who
from windup.sim_twin.wire.faults.fault_rule import Rule, make_rule


class EventMethods(ABC):
    """Events that befall what hangs on a bus.

    Every method adds one kind of event and returns the object, so that calls can be chained. All
    take the keywords of `Who`. Without ``rate`` and ``at`` an event happens once, now: as soon as
    time passes.
    """

    @property
    @abstractmethod
    def now(self) -> float:
        """The time from which `at` of an event that happens now is taken, s."""

    @abstractmethod
    def add(self, rule: Rule) -> Self:
        """Add a fault."""

    def dead(self, **who: Unpack[Who]) -> Self:
        """Let servos die: no answer and no torque, for ever."""
        return self.add(make_rule("dead", **self._when(who)))

    def reset(self, **who: Unpack[Who]) -> Self:
        """Let servos start again: torque off, RAM as after power-up."""
        return self.add(make_rule("reset", **self._when(who)))

    def overload(self, **who: Unpack[Who]) -> Self:
        """Make servos take themselves for overloaded, as with a horn that is held.

        Set up as it leaves the factory, a Dynamixel X sets bit 5 of Hardware Error Status (70) and
        the alert bit of its answers, and lets go until it is rebooted. A servo of protocol 1 sets
        bit 5 of the error byte of its answers and lets go; a Feetech servo sets that bit, too, and
        pushes no harder than its Protective Torque.
        """
        return self.add(make_rule("overload", **self._when(who)))

    def heat(self, degrees: float = 75.0, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let motors be hot at once, and no cooler for some time.

        Args:
            degrees: How hot, degrees C, up to 255.
            seconds: For how long, s; for ever by default.
            **who: See `Who`.
        """
        return self.add(make_rule("heat", degrees=degrees, seconds=seconds, **self._when(who)))

    def brown_out(
        self, volts: float = 0.0, seconds: float | None = None, **when: Unpack[When]
    ) -> Self:
        """Let the supply of everything sink for some time.

        Args:
            volts: To how much, V.
            seconds: For how long, s; 0.1 by default.
            **when: See `When`.
        """
        return self.add(make_rule("brown_out", volts=volts, seconds=seconds, **self._when(when)))

    def unplug(self, seconds: float | None = None, **when: Unpack[When]) -> Self:
        """Pull the adapter out: open ports fail for good, and can be opened again later.

        Args:
            seconds: When it is put in again, s from then; 0.5 by default, `math.inf`: never.
            **when: See `When`.
        """
        return self.add(make_rule("unplug", seconds=seconds, **self._when(when)))

    def imu_silent(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let the IMU, and a board that it is on, say nothing.

        Args:
            seconds: For how long, s; for ever by default.
            **who: See `Who`.
        """
        return self.add(make_rule("imu_silent", seconds=seconds, **self._when(who)))

    def imu_frozen(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let the IMU repeat one sample.

        Args:
            seconds: For how long, s; for ever by default.
            **who: See `Who`.
        """
        return self.add(make_rule("imu_frozen", seconds=seconds, **self._when(who)))

    def imu_spin(
        self, speed: float = 3.0, seconds: float | None = None, **who: Unpack[Who]
    ) -> Self:
        """Let the gyroscope read a constant rate about x.

        Args:
            speed: What it reads, rad/s.
            seconds: For how long, s; for ever by default.
            **who: See `Who`.
        """
        return self.add(make_rule("imu_spin", speed=speed, seconds=seconds, **self._when(who)))

    def button(self, seconds: float | None = None, **when: Unpack[When]) -> Self:
        """Press the user button of an OpenCR.

        Args:
            seconds: For how long, s; 0.2 by default.
            **when: See `When`.
        """
        return self.add(make_rule("button", seconds=seconds, **self._when(when)))

    def _when(self, given: Who | When) -> Who:
        """Return the keywords of an event: now, where neither rate nor time is given."""
        keywords = Who(**given)
        if "rate" not in keywords and "at" not in keywords:
            keywords["at"] = self.now
        return keywords
