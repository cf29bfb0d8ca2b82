"""Reads one family of servos for a long time under faults, and compares with the truth."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import count
from typing import Final

import numpy as np

from windup.hal.joints import Array, Mask
from windup.hal.servo_bus.plausibility import FASTER, MARGIN
from windup.sim_twin.wire.faults.fault_rule import ANSWERS, SECONDS, make_rule
from windup.tools.benches.soak_rig import SoakRig

PERIOD = 0.008  # s between two cycles, as in a loop at 125 Hz
BREAKDOWNS: Final = ("dead", "reset", "brown_out", "overload", "unplug")
OUTAGE: Final = {"brown_out": 0.05, "unplug": 0.1}  # durations, s
DEAD_FOR = 5  # number of cycles until a dead servo is powered again


@dataclass
class Tally:
    """The counts of many readings; tallies can be added.

    Attributes:
        reads: Number of servo readings requested while the port was open.
        fresh: Number of readings that the backend reported as fresh.
        faults: Number of times that each kind of fault happened.
        stale: Number of fresh readings with the value of an earlier cycle.
        borrowed: Number of fresh readings from another servo, with a wrong id and a valid checksum.
        garbled: Number of fresh readings with a value that no servo had.
        outside: Number of those three that the range and step check should have refused.
        refused: Number of correct frames that this check did refuse.
        waited: Longest run of cycles without a fault in which a servo had no fresh reading.
        raised: Texts of the exceptions raised by the backend, with their counts.
    """

    reads: int = 0
    fresh: int = 0
    faults: Counter[str] = field(default_factory=Counter)
    stale: int = 0
    borrowed: int = 0
    garbled: int = 0
    outside: int = 0
    refused: int = 0
    waited: int = 0
    raised: Counter[str] = field(default_factory=Counter)

    def add(self, other: "Tally") -> None:
        """Add another tally."""
        for key in ("reads", "fresh", "stale", "borrowed", "garbled", "outside", "refused"):
            setattr(self, key, getattr(self, key) + getattr(other, key))
        self.waited = max(self.waited, other.waited)
        self.faults.update(other.faults)
        self.raised.update(other.raised)


class Soak:
    """A rig under faults, with the classification of every reading.

    Args:
        rig: The servos.
        kinds: Share of the answers, or requests, that each kind of fault hits.
        seed: Seed of the events.
        breakdowns: Share of the cycles with each kind of failure of servo, supply or adapter.
    """

    def __init__(
        self, rig: SoakRig, kinds: Mapping[str, float], seed: int, breakdowns: float = 0.0
    ) -> None:
        self.rig, self.rate = rig, breakdowns
        self.tally = Tally()
        self._dice = np.random.default_rng(seed)
        self._before = rig.truth
        self._last, self._when = rig.truth.copy(), np.zeros(rig.servos)
        self._blind = np.zeros(rig.servos, dtype=int)
        self._dead: dict[int, int] = {}
        self._broken_until = 0.0  # end of the delay of an answer that was held back, s
        units = rig.backend.units
        self._margin, self._reach = MARGIN * (units.last + 1.0), FASTER * units.speed
        for kind, rate in kinds.items():
            rig.faults.add(make_rule(kind, rate))

    def run(self, reads: int) -> Tally:
        """Read until `reads` readings were requested, and return the tally."""
        clock = self.rig.backend.clock
        began, tick = clock.now(), 0
        for cycle in count():
            if self.tally.reads >= reads or self.tally.raised:
                break
            # Late ticks are skipped, as in the loop.
            tick = max(tick, int((clock.now() - began) / PERIOD)) + 1
            clock.wait_until(began + tick * PERIOD)
            self._events(cycle)
            self.rig.turn()
            self._cycle()
        self.tally.faults.update(self.rig.faults.counts)
        self.tally.refused = self.rig.backend.bus_errors()["implausible"]
        return self.tally

    def _events(self, cycle: int) -> None:
        """Trigger failures of servos, supply and adapter, each kind in its share of the cycles."""
        for kind in BREAKDOWNS:
            if self._dice.random() < self.rate:
                servo = int(self._dice.integers(1, self.rig.servos + 1))
                if kind == "dead":
                    self._dead[servo] = cycle + DEAD_FOR
                seconds = OUTAGE.get(kind)
                self.rig.faults.apply_now(make_rule(kind, at=0.0, ids=[servo], seconds=seconds))
        for servo in [servo for servo, until in self._dead.items() if until <= cycle]:
            del self._dead[servo]
            self.rig.repair(servo)

    def _cycle(self) -> None:
        rig, tally = self.rig, self.tally
        lost, listening, hits = bool(rig.backend.lost), rig.listening(), rig.faults.hits
        over = rig.backend.clock.now() >= self._broken_until
        hits.clear()
        try:
            seen, fresh, true = rig.read()
        except Exception as error:  # any exception of the backend is a finding
            tally.raised[f"{type(error).__name__}: {error}"] += 1
            return
        tally.reads += 0 if lost else rig.servos
        tally.fresh += int(fresh.sum())
        if (wrong := fresh & ~true).any():
            self._note_wrong(rig.counts(seen), wrong)
        clean = over and not hits and not lost and not rig.backend.lost
        self._blind = np.where(listening & ~fresh & clean, self._blind + 1, 0)
        tally.waited = max(tally.waited, int(self._blind.max()))
        self._last[fresh] = rig.counts(seen)[fresh]
        self._when[fresh] = seen.time
        self._before = rig.truth
        over_at = [hit.time + SECONDS[hit.kind] for hit in hits if hit.kind in ANSWERS]
        self._broken_until = max(over_at, default=self._broken_until)

    def _note_wrong(self, counts: Array, wrong: Mask) -> None:
        tally, now = self.tally, self.rig.backend.clock.now()
        strangers = [hit.identifier - 1 for hit in self.rig.faults.hits if hit.kind == "wrong_id"]
        for servo in np.flatnonzero(wrong):
            said = np.rint(counts[servo])
            if said == self._before[servo]:
                tally.stale += 1
            elif said in self.rig.truth[strangers]:
                tally.borrowed += 1
            else:
                tally.garbled += 1
            allowed = self._margin[servo] + self._reach[servo] * (now - self._when[servo])
            inside = 0.0 <= said <= self.rig.backend.units.last[servo]
            far = abs(said - self._last[servo]) > allowed + 1.0
            tally.outside += int(not inside or far)
