"""What may become of readings under a kind of fault, and what must not."""

from math import sqrt
from typing import Any, Final

from windup.sim_twin.wire.faults.fault_rule import ANSWERS, REQUESTS
from windup.tools.benches.soak import Tally
from windup.tools.benches.soak_rig import FAMILIES

LATE_ADAPTER: Final = "late_adapter"
"""An adapter that holds everything back, by 16 ms from the start, without saying so."""
MIX: Final = "all"
"""Everything at once that a reader can tell, with servos, supply and adapter failing too."""
CHANCE: Final = ("corrupt", "cut", "noise", "wrong_length")
"""Only chance lets a frame through its checksum after these."""
UNSEEN: Final = ("stale", "zeros", "jump")
"""Nothing about these frames is wrong but what they say."""
KINDS: Final = (*ANSWERS, *REQUESTS, LATE_ADAPTER, MIX)
TOLD: Final = tuple(kind for kind in (*ANSWERS, *REQUESTS) if kind not in (*CHANCE, *UNSEEN))
"""Order, length or id tell these."""
MIXED: Final = tuple(kind for kind in (*TOLD, *CHANCE) if kind != "late_byte")
"""What goes wrong at once: with 20 ms of silence at every tenth request nothing else would."""
PASSES: Final = {"dynamixel2": 2.0**-16, "dynamixel2_plain": 2.0**-16}
"""Chance that a garbled frame has a checksum that fits; else 2^-8."""
RECOVER: Final = 6
"""Cycles after which all who can are heard again: two doubtful answers, and 30 ms of silence."""
WHOLE: Final = 20
"""Readings of one answer: those that are late are so together."""
SHORTEST: Final = 12
"""Bytes of a servo's answer, of any family."""
FAR: Final = 2e-3
"""Share of the readings before which a servo was silent so long that it may have got to 0."""
EARLY: Final = 0.1
"""Share of the late answers that come when the next one would."""
STRANGERS: Final = 252
"""Ids that a wrong one may be."""


def verdict(family: str, kind: str, rate: float, tally: Tally, position: float) -> dict[str, Any]:
    """Return what became of the readings, beside what may have.

    Args:
        family: A key of `FAMILIES`.
        kind: One of `KINDS`.
        rate: Share of the answers that it hit.
        tally: What came of it.
        position: Share of the position in the bytes of an answer.
    """
    wrong = tally.stale + tally.borrowed + tally.garbled
    most = expected(family, kind, rate, tally, position)
    good = not (tally.raised or tally.outside or tally.waited > RECOVER)
    return {
        "servo": FAMILIES[family],
        "family": family,
        "kind": kind,
        "rate": rate,
        "reads": tally.reads,
        "fresh": tally.fresh,
        "hits": sum(tally.faults.values()),
        "wrong_and_fresh": wrong,
        "of_an_earlier_cycle": tally.stale,
        "of_another_servo": tally.borrowed,
        "of_nobody": tally.garbled,
        "expected_at_most": round(most, 2),
        "refused_by_range_and_step": tally.refused,
        "outside_range_and_step": tally.outside,
        "cycles_to_recover": tally.waited,
        "exceptions": dict(tally.raised),
        "met": good and wrong <= _bound(most) + (WHOLE if kind == "late_byte" else 0),
    }


def expected(family: str, kind: str, rate: float, tally: Tally, position: float) -> float:
    """Return how many wrong readings, at most, nothing in order, length, id or checksum tells."""
    if kind in UNSEEN:
        share = {"stale": 1.0, "zeros": FAR, "jump": position}[kind]
        return share * tally.faults[kind]
    # A whole answer that is late to its first byte, alone where the next one is so too, or is lost.
    if kind == "late_byte":
        return tally.faults[kind] * 3.0 * rate / SHORTEST**2
    late = sum(tally.faults[each] for each in ("late", "delay", "glue")) if kind == MIX else 0
    garbled = sum(tally.faults[each] for each in CHANCE) * PASSES.get(family, 2.0**-8)
    # Under the id of its neighbour in turn, which is silent, an answer is in its order.
    silent = 1.0 - tally.fresh / tally.reads if tally.reads and kind == MIX else 0.0
    alone = late * len(CHANCE) * rate * EARLY
    return garbled + alone + tally.faults["wrong_id"] * 2.0 / STRANGERS * silent


def _bound(most: float) -> float:
    """Return what a count whose mean is `most` reaches once in about a thousand times."""
    return most + 3.0 * sqrt(most) + (most > 0.0)
