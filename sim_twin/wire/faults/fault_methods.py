"""One method for each kind of fault."""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import Self, TypedDict, Unpack

from windup.sim_twin.wire.faults.fault_rule import Rule, Times, make_rule


class When(TypedDict, total=False):
    """How often a fault happens, or when.

    Attributes:
        rate: Share of the answers that it hits; 0.01 by default.
        at: Instead of a rate the time, s, or several: the first answer from then on is hit, or
            servos, supply and adapter at that very moment.
        bus: The bus it is confined to.
    """

    rate: float
    at: Times
    bus: str


class Who(When, total=False):
    """How often or when, and whom.

    Attributes:
        ids: The ids that can be hit; everybody by default.
    """

    ids: Iterable[int]


class FaultMethods(ABC):
    """Every method adds one kind of fault and returns the object, so that calls can be chained.

    See `Who` for their keywords.
    """

    @abstractmethod
    def add(self, rule: Rule) -> Self:
        """Add a fault."""

    def drop(self, **who: Unpack[Who]) -> Self:
        """Lose answers."""
        return self.add(make_rule("drop", **who))

    def corrupt(self, **who: Unpack[Who]) -> Self:
        """Change one byte of answers."""
        return self.add(make_rule("corrupt", **who))

    def cut(self, **who: Unpack[Who]) -> Self:
        """Lose the end of answers."""
        return self.add(make_rule("cut", **who))

    def noisy(self, **who: Unpack[Who]) -> Self:
        """Put up to eight random bytes before answers."""
        return self.add(make_rule("noise", **who))

    def late(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let servos answer late; those behind them in a sync read wait."""
        return self.add(make_rule("late", seconds=seconds, **who))

    def delay(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let the adapter hold answers back for some seconds, and what comes behind them."""
        return self.add(make_rule("delay", seconds=seconds, **who))

    def wrong_id(self, **who: Unpack[Who]) -> Self:
        """Have answers come from another id, with a checksum that fits."""
        return self.add(make_rule("wrong_id", **who))

    def wrong_length(self, **who: Unpack[Who]) -> Self:
        """Change the length byte of answers."""
        return self.add(make_rule("wrong_length", **who))

    def glue(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Hold answers back until the next one is there, for some seconds at most."""
        return self.add(make_rule("glue", seconds=seconds, **who))

    def longer(self, **who: Unpack[Who]) -> Self:
        """Put a few bytes too many into answers, with a checksum that fits."""
        return self.add(make_rule("longer", **who))

    def shorter(self, **who: Unpack[Who]) -> Self:
        """Leave a few bytes of data out of answers, with a checksum that fits."""
        return self.add(make_rule("shorter", **who))

    def zeros(self, **who: Unpack[Who]) -> Self:
        """Let all data of answers be zero, with a checksum that fits."""
        return self.add(make_rule("zeros", **who))

    def stale(self, **who: Unpack[Who]) -> Self:
        """Have servos repeat their last answer of the same length."""
        return self.add(make_rule("stale", **who))

    def jump(self, **who: Unpack[Who]) -> Self:
        """Change one byte of the data of answers, with a checksum that fits."""
        return self.add(make_rule("jump", **who))

    def twice(self, **who: Unpack[Who]) -> Self:
        """Have answers come twice."""
        return self.add(make_rule("twice", **who))

    def late_byte(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let the adapter hold back one byte of answers, and what comes behind it."""
        return self.add(make_rule("late_byte", seconds=seconds, **who))

    def echo(self, **when: Unpack[When]) -> Self:
        """Let the adapter give the host back what it sends, as on a bare half-duplex line."""
        return self.add(make_rule("echo", **when))

    def dead(self, **who: Unpack[Who]) -> Self:
        """Let servos die: no answer and no torque, for ever."""
        return self.add(make_rule("dead", **who))

    def reset(self, **who: Unpack[Who]) -> Self:
        """Let servos start again: torque off, RAM as after power-up."""
        return self.add(make_rule("reset", **who))

    def brown_out(
        self, volts: float = 0.0, seconds: float | None = None, **when: Unpack[When]
    ) -> Self:
        """Let the supply of everything sink to `volts` V for some seconds."""
        return self.add(make_rule("brown_out", volts=volts, seconds=seconds, **when))

    def overload(self, **who: Unpack[Who]) -> Self:
        """Make servos take themselves for overloaded."""
        return self.add(make_rule("overload", **who))

    def unplug(self, seconds: float | None = None, **when: Unpack[When]) -> Self:
        """Pull the adapter out, and put it in again after some seconds (`math.inf`: never)."""
        return self.add(make_rule("unplug", seconds=seconds, **when))

    def heat(self, degrees: float = 75.0, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let motors be `degrees` C hot at once, and no cooler for some seconds, or for ever."""
        return self.add(make_rule("heat", degrees=degrees, seconds=seconds, **who))

    def imu_silent(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let the IMU, and a board that it is on, say nothing for some seconds, or for ever."""
        return self.add(make_rule("imu_silent", seconds=seconds, **who))

    def imu_frozen(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let the IMU repeat one sample for some seconds, or for ever."""
        return self.add(make_rule("imu_frozen", seconds=seconds, **who))

    def imu_spin(
        self, speed: float = 3.0, seconds: float | None = None, **who: Unpack[Who]
    ) -> Self:
        """Let the gyroscope read `speed` rad/s about x for some seconds, or for ever."""
        return self.add(make_rule("imu_spin", speed=speed, seconds=seconds, **who))

    def button(self, seconds: float | None = None, **when: Unpack[When]) -> Self:
        """Press the user button of an OpenCR for some seconds."""
        return self.add(make_rule("button", seconds=seconds, **when))
