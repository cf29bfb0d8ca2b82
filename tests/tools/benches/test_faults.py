import numpy as np
import pytest

from windup.hal.errors import UsageError
from windup.sim_twin.wire.faults.fault_rule import ANSWERS, REQUESTS
from windup.tools.benches import faults as bench_faults
from windup.tools.benches.soak import BREAKDOWNS, Soak, Tally
from windup.tools.benches.soak_rig import FAMILIES, SoakRig
from windup.tools.benches.soak_table import fault_table
from windup.tools.benches.soak_verdict import (
    CHANCE,
    KINDS,
    LATE_ADAPTER,
    MIX,
    MIXED,
    RECOVER,
    TOLD,
    UNSEEN,
    verdict,
)

families = pytest.mark.parametrize("family", FAMILIES)


@families
def test_what_the_rig_reads_without_faults_is_true(family: str) -> None:
    with SoakRig(family, servos=4) as rig:
        for _ in range(30):
            rig.backend.clock.wait_until(rig.backend.clock.now() + 0.008)
            rig.turn()
            _, fresh, true = rig.read()
            assert fresh.all()
            assert true.all()


def test_every_kind_of_fault_is_judged_once() -> None:
    assert sorted([*TOLD, *CHANCE, *UNSEEN]) == sorted([*ANSWERS, *REQUESTS])


@families
def test_nothing_wrong_is_reported_fresh_while_everything_goes_wrong(family: str) -> None:
    with SoakRig(family, seed=3) as rig:
        tally = Soak(rig, dict.fromkeys(MIXED, 0.01), 3, 0.01).run(6000)
    hit = {kind for kind, times in tally.faults.items() if times}
    assert {*MIXED, *BREAKDOWNS} - {"echo"} <= hit  # few requests, many answers
    assert tally.reads >= 6000
    assert tally.fresh > 1000
    assert (tally.stale, tally.outside, dict(tally.raised)) == (0, 0, {})
    assert tally.waited <= RECOVER


@families
@pytest.mark.parametrize("kind", ["wrong_id", "late_byte", "echo", "twice", LATE_ADAPTER])
def test_what_order_length_or_id_tells_is_never_believed(family: str, kind: str) -> None:
    rate = 0.01 if kind == "late_byte" else 0.05  # each of those costs three cycles
    item = bench_faults.WorkItem(bench_faults.FaultCase(family, kind, rate), 6000, 1)
    tally, _ = bench_faults._soak(item)
    assert sum(tally.faults.values()) > 10
    assert tally.fresh > 200
    assert (tally.stale, tally.borrowed, tally.garbled, dict(tally.raised)) == (0, 0, 0, {})


def test_a_few_readings_of_everything_meet_what_is_expected() -> None:
    cells = len(FAMILIES) * (2 * len(KINDS) - 1)
    result = bench_faults.measure_faults(reads=40 * cells)
    assert result["met"], [cell for cell in result["cells"] if not cell["met"]]
    assert len(result["cells"]) == cells
    assert fault_table(result["cells"]).row_count == len(KINDS)


def test_readings_that_are_not_the_truth_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    with SoakRig("sts", servos=4) as rig:
        soak = Soak(rig, {}, seed=0)
        rig.backend.read()
        soak.rig.turn()
        monkeypatch.setattr(rig, "turn", lambda: None)
        before = rig.truth.copy()
        rig.truth = before + np.array([0.0, 500.0, 0.0, 0.0])
        tally = soak.run(4)
    assert (tally.fresh, tally.garbled, tally.outside) == (4, 1, 0)


def test_tallies_add_up() -> None:
    one, two = Tally(reads=3, waited=2), Tally(reads=4, waited=1)
    two.faults["drop"] = 5
    one.add(two)
    assert (one.reads, one.waited, one.faults["drop"]) == (7, 2, 5)


def judged(kind: str, tally: Tally) -> bool:
    return bool(verdict("sts", kind, 0.01, tally, 0.25)["met"])


def test_what_can_be_told_must_not_happen_once() -> None:
    assert judged("drop", Tally(reads=100, fresh=90, waited=1))
    for bad in (Tally(100, stale=1), Tally(100, borrowed=1), Tally(100, waited=7)):
        assert not judged("drop", bad)
    assert not judged("stale", Tally(100, outside=1))


def test_what_nothing_tells_may_happen_as_often_as_it_is_expected() -> None:
    hit = {"corrupt": 512, "stale": 30, "jump": 40}
    for kind, most in (("corrupt", 2), ("stale", 30), ("jump", 10)):
        for times, met in ((most, True), (3 * most + 10, False)):
            tally = Tally(reads=1000, fresh=900, garbled=times)
            tally.faults[kind] = hit[kind]
            assert judged(kind, tally) is met


def test_a_late_answer_may_be_alone_where_the_next_one_is_lost() -> None:
    tally = Tally(reads=1000, fresh=900, stale=4)
    assert not judged(MIX, tally)
    tally.faults["late"] = 500
    assert judged(MIX, tally)


def test_no_reads_are_refused() -> None:
    with pytest.raises(UsageError, match="--reads 0: give 1 or more"):
        bench_faults.measure_faults(0)
