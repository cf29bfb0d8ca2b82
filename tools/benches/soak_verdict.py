"""Judges the readings under a kind of fault: the expected number of wrong ones, and the limits."""

from math import sqrt
from typing import Any, Final

from windup.sim_twin.wire.faults.fault_rule import ANSWERS, REQUESTS
from windup.tools.benches.soak import Tally
from windup.tools.benches.soak_rig import FAMILIES

LATE_ADAPTER: Final = "late_adapter"
"""An adapter that delays everything by 16 ms from the start, unknown to the driver."""
MIX: Final = "all"
"""All detectable faults at once, with failures of servos, supply and adapter too."""
CHANCE: Final = ("corrupt", "cut", "noise", "wrong_length")
"""Faults after which a frame has a valid checksum only by chance."""
UNSEEN: Final = ("stale", "zeros", "jump")
"""Faults that yield valid frames in which only the data is wrong."""
KINDS: Final = (*ANSWERS, *REQUESTS, LATE_ADAPTER, MIX)
TOLD: Final = tuple(kind for kind in (*ANSWERS, *REQUESTS) if kind not in (*CHANCE, *UNSEEN))
"""Faults that the order, length or id of an answer reveals."""
MIXED: Final = tuple(kind for kind in (*TOLD, *CHANCE) if kind != "late_byte")
"""Faults in the mix, without late_byte: its 20 ms of silence would hide the others."""
PASSES: Final = {"dynamixel2": 2.0**-16, "dynamixel2_plain": 2.0**-16}
"""Probability that a garbled frame has a valid checksum; 2^-8 for other families."""
RECOVER: Final = 6
"""Cycles in which all servos must be read again: two doubtful answers, and 30 ms of silence."""
WHOLE: Final = 20
"""Readings of one answer, which are late together."""
SHORTEST: Final = 12
"""Smallest number of bytes of a servo's answer, over all families."""
FAR: Final = 2e-3
"""Share of the readings after a silence so long that the position may have got to 0."""
EARLY: Final = 0.1
"""Share of the late answers that arrive when the next one would."""
STRANGERS: Final = 252
"""Number of ids that a wrong one may be."""


def verdict(family: str, kind: str, rate: float, tally: Tally, position: float) -> dict[str, Any]:
    """Return the counts of the readings, beside the expected ones.

    Args:
        family: A key of `FAMILIES`.
        kind: One of `KINDS`.
        rate: Share of the answers that it hit.
        tally: Counts of the readings.
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
    """Return how many wrong readings at most no order, length, id or checksum should reveal."""
    if kind in UNSEEN:
        share = {"stale": 1.0, "zeros": FAR, "jump": position}[kind]
        return share * tally.faults[kind]
    # An answer late from its first byte on, if the next one is so too, or is lost.
    if kind == "late_byte":
        return tally.faults[kind] * 3.0 * rate / SHORTEST**2
    late = sum(tally.faults[each] for each in ("late", "delay", "glue")) if kind == MIX else 0
    garbled = sum(tally.faults[each] for each in CHANCE) * PASSES.get(family, 2.0**-8)
    # An answer with the id of the next servo in turn, which is silent, is in the correct order.
    silent = 1.0 - tally.fresh / tally.reads if tally.reads and kind == MIX else 0.0
    alone = late * len(CHANCE) * rate * EARLY
    return garbled + alone + tally.faults["wrong_id"] * 2.0 / STRANGERS * silent


def _bound(most: float) -> float:
    """Return a bound that a count of mean `most` exceeds about once in a thousand times."""
    return most + 3.0 * sqrt(most) + (most > 0.0)
