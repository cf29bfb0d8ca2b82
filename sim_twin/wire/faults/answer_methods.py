"""One method for each kind of fault of the bytes between servos and host."""

from abc import ABC, abstractmethod
from typing import Self, Unpack

from windup.sim_twin.wire.faults.fault_keywords import When, Who
from windup.sim_twin.wire.faults.fault_rule import Rule, make_rule


class AnswerFaultMethods(ABC):
    """Faults of answers on their way, and of what the host sends.

    Every method adds one kind of fault and returns the object, so that calls can be chained:
    ``bus.faults.drop(rate=0.02, ids=[7]).corrupt(rate=0.001)``. All take the keywords of `Who`:
    ``rate`` (share of the answers, 0 to 1; 0.01 by default) or ``at`` (s), ``ids``, ``bus``.
    """

    @abstractmethod
    def add(self, rule: Rule) -> Self:
        """Add a fault."""

    def drop(self, **who: Unpack[Who]) -> Self:
        """Lose whole answers: the host runs into its time-out."""
        return self.add(make_rule("drop", **who))

    def corrupt(self, **who: Unpack[Who]) -> Self:
        """Change one byte of an answer, anywhere: most often its checksum fails."""
        return self.add(make_rule("corrupt", **who))

    def cut(self, **who: Unpack[Who]) -> Self:
        """Lose the end of an answer, from a random byte on."""
        return self.add(make_rule("cut", **who))

    def noisy(self, **who: Unpack[Who]) -> Self:
        """Put one to eight random bytes before an answer."""
        return self.add(make_rule("noise", **who))

    def late(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let a servo answer late; those behind it in a sync read wait.

        Args:
            seconds: How much later its answer begins, s; 0.002 by default.
            **who: See `Who`.
        """
        return self.add(make_rule("late", seconds=seconds, **who))

    def delay(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let the adapter hold back an answer and everything behind it, as a busy USB hub does.

        Args:
            seconds: For how long, s; 0.004 by default.
            **who: See `Who`.
        """
        return self.add(make_rule("delay", seconds=seconds, **who))

    def wrong_id(self, **who: Unpack[Who]) -> Self:
        """Have an answer come under another id, with a checksum that fits."""
        return self.add(make_rule("wrong_id", **who))

    def wrong_length(self, **who: Unpack[Who]) -> Self:
        """Change the length byte of an answer."""
        return self.add(make_rule("wrong_length", **who))

    def glue(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let the adapter hold back an answer until the next one is there.

        Args:
            seconds: For how long at most, s; 0.004 by default.
            **who: See `Who`.
        """
        return self.add(make_rule("glue", seconds=seconds, **who))

    def longer(self, **who: Unpack[Who]) -> Self:
        """Put a few bytes too many into an answer, with a checksum that fits."""
        return self.add(make_rule("longer", **who))

    def shorter(self, **who: Unpack[Who]) -> Self:
        """Leave a few bytes of data out of an answer, with a checksum that fits."""
        return self.add(make_rule("shorter", **who))

    def zeros(self, **who: Unpack[Who]) -> Self:
        """Let all data of an answer be zero, with a checksum that fits."""
        return self.add(make_rule("zeros", **who))

    def stale(self, **who: Unpack[Who]) -> Self:
        """Have a servo repeat its last answer of the same length."""
        return self.add(make_rule("stale", **who))

    def jump(self, **who: Unpack[Who]) -> Self:
        """Change one byte of the data of an answer, with a checksum that fits."""
        return self.add(make_rule("jump", **who))

    def twice(self, **who: Unpack[Who]) -> Self:
        """Have an answer come twice."""
        return self.add(make_rule("twice", **who))

    def late_byte(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let the adapter hold back one byte of an answer, and what comes behind it.

        Args:
            seconds: For how long, s; 0.02 by default.
            **who: See `Who`.
        """
        return self.add(make_rule("late_byte", seconds=seconds, **who))

    def echo(self, **when: Unpack[When]) -> Self:
        """Let the adapter give the host back what it sends, as a bare half-duplex line does.

        Here `rate` is a share of the requests: 1 is a line that always echoes.
        """
        return self.add(make_rule("echo", **when))
