"""A million readings of each family of servos while everything goes wrong, beside the truth."""

from typing import Any

from hal.errors import UsageError
from tools.parallel import side_by_side
from tools.soak import GARBLED, Soak, Tally
from tools.soak_rig import FAMILIES, SoakRig

RATE = 0.01
CHUNK = 25_000  # readings of one emulated bus
CHANCE = {"dynamixel2": 2.0**-16}  # that a garbled frame fits its checksum; else 2^-8


def measure_faults(name: str, reads: int = 1_000_000, seed: int = 0) -> dict[str, Any]:
    """Return what became of `reads` servo-reads of each family, with every fault at 1 %.

    Answers are hit at that rate each; a servo dies or starts again, the supply sags or the adapter
    is pulled out in as many of the cycles.

    Args:
        name: Ignored: the buses are benches of 20 servos of one family.
        reads: Of each family.
        seed: Seed of the faults.

    Raises:
        UsageError: `reads` is below 1.
    """
    if reads < 1:
        raise UsageError(f"--reads {reads}: give 1 or more")
    chunks = max(1, round(reads / CHUNK))
    each = -(-reads // chunks)
    items = [(family, each, seed + chunk) for chunk in range(chunks) for family in FAMILIES]
    tallies = {family: Tally() for family in FAMILIES}
    for (family, _, _), tally in side_by_side(_soak, items, label="faults"):
        tallies[family].add(tally)
    return {family: _row(family, tally) for family, tally in tallies.items()}


def _soak(item: tuple[str, int, int]) -> Tally:
    family, reads, seed = item
    with SoakRig(family, seed=seed) as rig:
        return Soak(rig, RATE, seed).run(reads)


def _row(family: str, tally: Tally) -> dict[str, Any]:
    garbled = sum(tally.faults[kind] for kind in GARBLED)
    chance = CHANCE.get(family, 2.0**-8)
    return {
        "reads": tally.reads,
        "fresh": tally.fresh,
        "faults": sum(tally.faults.values()),
        "stale_but_fresh": tally.stale,
        "wrong_ids": tally.faults["wrong_id"],
        "wrong_ids_passed": tally.borrowed,
        "garbled": garbled,
        "garbled_passed": tally.garbled,
        "garbled_expected_to_pass": round(garbled * chance, 1),
        "refused_by_range_and_step": tally.refused,
        "outside_range_and_step": tally.outside,
        "cycles_to_recover": tally.waited,
        "exceptions": dict(tally.raised),
        "met": not (tally.stale or tally.outside or tally.raised or tally.waited > 1)
        and tally.garbled <= max(1.0, garbled * chance),
    }
