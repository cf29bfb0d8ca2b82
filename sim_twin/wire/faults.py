"""Faults on the way of the answers, seeded, so that a run can be had again."""

import random
from dataclasses import dataclass, field

from hal.errors import UsageError, suggest

KINDS = ("drop", "corrupt")


@dataclass
class Faults:
    """What happens to answers between servo and host.

    Attributes:
        drop: Share of the answers that are lost.
        corrupt: Share of the answers with one byte changed.
        seed: Seed of the dice.
        counts: Kind to the number of answers it hit.
    """

    drop: float = 0.0
    corrupt: float = 0.0
    seed: int = 0
    counts: dict[str, int] = field(default_factory=lambda: dict.fromkeys(KINDS, 0))

    def __post_init__(self) -> None:
        self._dice = random.Random(self.seed)
        self._any = self.drop + self.corrupt > 0.0

    @classmethod
    def parse(cls, text: str, seed: int = 0) -> "Faults":
        """Return the faults of a text like ``drop:0.01,corrupt:0.001``.

        Raises:
            UsageError: The text says something else.
        """
        rates: dict[str, float] = {}
        for part in filter(None, text.split(",")):
            kind, _, rate = part.partition(":")
            if kind not in KINDS:
                raise UsageError(f"faults: unknown kind {kind!r}{suggest(kind, KINDS)}")
            try:
                rates[kind] = float(rate)
            except ValueError:
                rates[kind] = -1.0
            if not 0.0 <= rates[kind] <= 1.0:
                raise UsageError(f"faults: {part!r}: a rate from 0 to 1, as in 'drop:0.01'")
        return cls(rates.get("drop", 0.0), rates.get("corrupt", 0.0), seed)

    def answer(self, data: bytes) -> bytes:
        """Return what the host gets of an answer; nothing where it is lost."""
        if not self._any:
            return data
        if self._hit("drop", self.drop):
            return b""
        if self._hit("corrupt", self.corrupt):
            place = self._dice.randrange(len(data))
            changed = data[place] ^ self._dice.randrange(1, 256)
            return data[:place] + bytes((changed,)) + data[place + 1 :]
        return data

    def noise(self, count: int) -> bytes:
        """Return bytes as of a collision or a wrong baud rate."""
        return self._dice.randbytes(count)

    def _hit(self, kind: str, rate: float) -> bool:
        if rate <= 0.0 or self._dice.random() >= rate:
            return False
        self.counts[kind] += 1
        return True
