"""One method for each kind of fault of the bytes between servos and host."""

from abc import ABC, abstractmethod
from typing import Self, Unpack

from windup.sim_twin.wire.faults.fault_keywords import TargetKeywords, TimeKeywords
from windup.sim_twin.wire.faults.fault_rule import FaultRule, make_rule


class AnswerFaultMethods(ABC):
    """Adds faults of status packets in transit, and of the bytes that the host sends.

    Each method adds one fault and returns the object, so that calls can be chained:
    ``bus.faults.drop(rate=0.02, ids=[7]).corrupt(rate=0.001)``. All take
    the keywords of `TargetKeywords`: ``rate`` (share of the answers, 0 to 1; 0.01 by default) or
    ``at`` (s), ``ids``, ``bus``.
    """

    @abstractmethod
    def add(self, rule: FaultRule) -> Self:
        """Add a fault."""

    def drop(self, **who: Unpack[TargetKeywords]) -> Self:
        """Lose whole answers, so that the host times out."""
        return self.add(make_rule("drop", **who))

    def corrupt(self, **who: Unpack[TargetKeywords]) -> Self:
        """Change one random byte of an answer; its checksum usually fails."""
        return self.add(make_rule("corrupt", **who))

    def cut(self, **who: Unpack[TargetKeywords]) -> Self:
        """Lose the end of an answer, from a random byte on."""
        return self.add(make_rule("cut", **who))

    def noisy(self, **who: Unpack[TargetKeywords]) -> Self:
        """Insert one to eight random bytes before an answer."""
        return self.add(make_rule("noise", **who))

    def late(self, seconds: float | None = None, **who: Unpack[TargetKeywords]) -> Self:
        """Delay the answer of a servo, and of the servos after it in a sync read.

        Args:
            seconds: Additional delay, s; 0.002 by default.
            **who: See `TargetKeywords`.
        """
        return self.add(make_rule("late", seconds=seconds, **who))

    def delay(self, seconds: float | None = None, **who: Unpack[TargetKeywords]) -> Self:
        """Delay the delivery of an answer and of all later bytes, as a busy USB hub does.

        Args:
            seconds: Delay, s; 0.004 by default.
            **who: See `TargetKeywords`.
        """
        return self.add(make_rule("delay", seconds=seconds, **who))

    def wrong_id(self, **who: Unpack[TargetKeywords]) -> Self:
        """Change the id of an answer, and its checksum accordingly."""
        return self.add(make_rule("wrong_id", **who))

    def wrong_length(self, **who: Unpack[TargetKeywords]) -> Self:
        """Change the length byte of an answer."""
        return self.add(make_rule("wrong_length", **who))

    def glue(self, seconds: float | None = None, **who: Unpack[TargetKeywords]) -> Self:
        """Deliver an answer together with the next one.

        Args:
            seconds: Longest delay, s; 0.004 by default.
            **who: See `TargetKeywords`.
        """
        return self.add(make_rule("glue", seconds=seconds, **who))

    def longer(self, **who: Unpack[TargetKeywords]) -> Self:
        """Append a few bytes to the data of an answer; length and checksum fit."""
        return self.add(make_rule("longer", **who))

    def shorter(self, **who: Unpack[TargetKeywords]) -> Self:
        """Remove the last bytes of the data of an answer; length and checksum fit."""
        return self.add(make_rule("shorter", **who))

    def zeros(self, **who: Unpack[TargetKeywords]) -> Self:
        """Set all data of an answer to zero; the checksum fits."""
        return self.add(make_rule("zeros", **who))

    def stale(self, **who: Unpack[TargetKeywords]) -> Self:
        """Repeat the servo's previous answer of the same length."""
        return self.add(make_rule("stale", **who))

    def jump(self, **who: Unpack[TargetKeywords]) -> Self:
        """Change one byte of the data of an answer; the checksum fits."""
        return self.add(make_rule("jump", **who))

    def twice(self, **who: Unpack[TargetKeywords]) -> Self:
        """Deliver an answer twice."""
        return self.add(make_rule("twice", **who))

    def late_byte(self, seconds: float | None = None, **who: Unpack[TargetKeywords]) -> Self:
        """Delay the delivery of one random byte of an answer and of all later bytes.

        Args:
            seconds: Delay, s; 0.02 by default.
            **who: See `TargetKeywords`.
        """
        return self.add(make_rule("late_byte", seconds=seconds, **who))

    def echo(self, **when: Unpack[TimeKeywords]) -> Self:
        """Echo the host's own bytes back to it, as a half-duplex line without a switch does.

        Here `rate` is a share of the requests: with 1 the line always echoes.
        """
        return self.add(make_rule("echo", **when))
