import numpy as np
import pytest

from hal.errors import UsageError
from sim_twin.wire.fault_rule import ANSWERS
from tools import bench_faults
from tools.soak import BREAKDOWNS, Soak, Tally
from tools.soak_rig import FAMILIES, SoakRig


@pytest.mark.parametrize("family", FAMILIES)
def test_what_the_rig_reads_without_faults_is_true(family: str) -> None:
    with SoakRig(family, servos=4) as rig:
        for _ in range(30):
            rig.backend.clock.wait_until(rig.backend.clock.now() + 0.008)
            rig.turn()
            _, fresh, true = rig.read()
            assert fresh.all()
            assert true.all()


@pytest.mark.parametrize("family", FAMILIES)
def test_nothing_wrong_is_reported_fresh_while_everything_goes_wrong(family: str) -> None:
    with SoakRig(family, seed=3) as rig:
        tally = Soak(rig, 0.01, seed=3).run(6000)
    assert {*ANSWERS, *BREAKDOWNS} == {kind for kind, times in tally.faults.items() if times}
    assert tally.reads >= 6000
    assert tally.fresh > 2000
    assert (tally.stale, tally.outside, dict(tally.raised)) == (0, 0, {})
    assert tally.waited <= 1


def test_readings_that_are_not_the_truth_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    with SoakRig("sts", servos=4) as rig:
        soak = Soak(rig, 0.0, seed=0)
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


def test_a_family_meets_it_only_without_stale_readings() -> None:
    good = Tally(reads=100, fresh=90, waited=1)
    assert bench_faults._row("sts", good)["met"]
    for bad in (Tally(100, stale=1), Tally(100, outside=1), Tally(100, waited=2)):
        assert not bench_faults._row("sts", bad)["met"]


def test_no_reads_are_refused() -> None:
    with pytest.raises(UsageError, match="--reads 0: give 1 or more"):
        bench_faults.measure_faults("op3", 0)
