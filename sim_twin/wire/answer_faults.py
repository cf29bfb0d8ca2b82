"""What goes wrong with an answer on its way from a device to the host."""

import math
import random
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from sim_twin.wire.bus import Bus
    from sim_twin.wire.inbox import Burst

IDS = 253
TIMED: Final = frozenset(("late", "delay", "glue"))  # these leave the bytes alone

Spoil = Callable[[bytes, random.Random], bytes]
_SPOIL: Final[dict[str, Spoil]] = {
    "drop": lambda data, dice: b"",
    "cut": lambda data, dice: data[: dice.randrange(len(data))],
    "noise": lambda data, dice: dice.randbytes(dice.randint(1, 8)) + data,
}


@dataclass
class Fate:
    """What becomes of one answer.

    Attributes:
        got: What the host gets of it.
        late: By how much it leaves the device later, s.
        held: Until when the adapter holds it back, s.
        glued: How long at most it waits for the next one, s.
    """

    got: bytes
    late: float = 0.0
    held: float = 0.0
    glued: float = 0.0

    def suffer(self, kind: str, seconds: float, bus: "Bus", dice: random.Random) -> None:
        """Have one fault of `fault_rule.ANSWERS` done to it."""
        if kind == "late":
            self.late += seconds
        elif kind == "delay":
            self.held = max(self.held, bus.schedule.now + seconds)
        elif kind == "glue":
            self.glued = seconds
        elif kind in _SPOIL:
            self.got = _SPOIL[kind](self.got, dice)
        else:
            self.got = _change_byte(kind, self.got, bus, dice)


class Sender:
    """Puts answers on their buses as their fate has it."""

    def __init__(self) -> None:
        self._glued: dict[str, Burst] = {}

    def send(self, bus: "Bus", data: bytes, baud: int, fate: Fate) -> float:
        """Put an answer on the wire; return when it ends, s."""
        put = partial(self._put, bus, data, baud, fate)
        if fate.late <= 0.0:
            return put()
        start = bus.schedule.now + fate.late
        bus.schedule.at(start, put)
        return start + len(data) * 10.0 / baud

    def _put(self, bus: "Bus", data: bytes, baud: int, fate: Fate) -> float:
        """Put it there; one that was glued to it comes with its last byte."""
        end = bus.put(data, baud, fate.got, math.inf if fate.glued else fate.held)
        burst = bus.inbox.last
        if not fate.got or burst is None:
            return end
        waiting = self._glued.pop(bus.name, None)
        if waiting is not None and waiting.held == math.inf:
            waiting.held = end
            burst.held = max(burst.held, end)
        if fate.glued:
            self._glued[bus.name] = burst
            bus.schedule.at(end + fate.glued, partial(_release, burst, end + fate.glued))
        return end


def _change_byte(kind: str, data: bytes, bus: "Bus", dice: random.Random) -> bytes:
    """Return `data` with another id, another length, or another byte anywhere."""
    language = bus.language
    place = {"wrong_id": language.id_at, "wrong_length": language.length_at}.get(kind)
    if place is None or place >= len(data):
        place = dice.randrange(len(data))
    changed = data[place] ^ dice.randrange(1, 256)
    if kind == "wrong_id":
        changed = (data[place] + dice.randrange(1, IDS)) % IDS
    spoilt = data[:place] + bytes((changed,)) + data[place + 1 :]
    return language.seal(spoilt) if kind == "wrong_id" else spoilt


def _release(burst: "Burst", time: float) -> None:
    """Stop waiting for an answer to glue to."""
    if burst.held == math.inf:
        burst.held = time
