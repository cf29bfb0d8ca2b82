import numpy as np
import pytest

from windup.hal.errors import UsageError
from windup.hal.guard import CROUCH_SECONDS
from windup.tools.benches.safety import bench
from windup.tools.benches.safety.bench import _moments, measure_safety
from windup.tools.benches.safety.moment import Moment
from windup.tools.benches.safety.row import HANG, STOP, Ending
from windup.tools.benches.safety.rows import ROWS
from windup.tools.benches.safety.trial import NotMeasuredError
from windup.tools.benches.safety.verdict import Verdict


def test_every_row_has_a_name_of_its_own_and_something_to_allow() -> None:
    names = [row.name for row in ROWS]
    assert len(set(names)) == len(names)
    assert all(row.status and row.activities and row.within >= STOP for row in ROWS)


def test_a_crouch_is_allowed_its_time_and_a_hang_the_guardians_patience() -> None:
    rows = {row.name: row for row in ROWS}
    assert rows["SIGINT"].allowed(crouches=False) == STOP
    assert rows["SIGINT"].allowed(crouches=True) > STOP + CROUCH_SECONDS
    assert rows["controller spins"].allowed(crouches=False) == HANG
    assert rows["SIGINT x 8, 20 ms apart"].allowed(crouches=True) < 0.4


def test_moments_are_drawn_over_robots_and_activities_alike_and_again_for_a_seed() -> None:
    def draw(seed: int) -> list[tuple[str, Moment]]:
        return list(_moments(ROWS[0], 12, np.random.default_rng(seed), ("op3", "duck")))

    drawn = draw(0)
    assert drawn == draw(0) != draw(1)
    assert [name for name, _ in drawn].count("op3") == 6
    activities = [moment.activity for name, moment in drawn if name == "duck"]
    assert {activities.count(each) for each in ROWS[0].activities} == {2}


def test_a_row_that_no_robot_of_these_has_is_not_tried() -> None:
    row = next(row for row in ROWS if row.robots == ("op3",))
    assert list(_moments(row, 4, np.random.default_rng(0), ("duck",))) == []


def test_what_is_not_safe_is_counted_told_and_ends_with_status_1(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    said = iter(["", "driven for 0.31 s"])

    def one(name: str, row: Ending, moment: Moment) -> Verdict:
        wrong = next(said)
        return Verdict(moment.activity, moment.after, 0.31 if wrong else 0.1, 130, "off", wrong)

    monkeypatch.setattr(bench, "_one", one)
    result = measure_safety(2, only=["SIGHUP"], robots=("duck",))
    assert (result["safe"], result["trials"], result["met"]) == (1, 2, False)
    row = result["rows"]["SIGHUP"]
    assert row["longest_s"] == 0.31 and row["wrong"][0]["wrong"] == "driven for 0.31 s"


def test_a_program_that_was_not_under_way_is_tried_again_and_counted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tries: list[Moment] = []

    def one(name: str, row: Ending, moment: Moment) -> Verdict:
        tries.append(moment)
        if len(tries) == 1:
            raise NotMeasuredError("it fell")
        return Verdict(moment.activity, moment.after, 0.1, 130, "off", "")

    monkeypatch.setattr(bench, "_one", one)
    row = measure_safety(1, only=["SIGHUP"], robots=("op3",))["rows"]["SIGHUP"]
    assert row["trials"] == 1 and row["not_measured"] == {"op3: it fell": 1}


def test_what_could_not_be_measured_is_not_met_and_is_said(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def one(name: str, row: Ending, moment: Moment) -> Verdict:
        if name == "duck":
            raise NotMeasuredError("it fell")
        return Verdict(moment.activity, moment.after, 0.1, 130, "off", "")

    monkeypatch.setattr(bench, "_one", one)
    result = measure_safety(4, only=["SIGHUP"], robots=("op3", "duck"))
    assert (result["safe"], result["planned"], result["trials"]) == (2, 4, 2)
    assert result["met"] is False
    row = result["rows"]["SIGHUP"]
    assert (row["planned"], row["trials"], row["safe"]) == (4, 2, 2)
    said = capfd.readouterr().err
    assert "SIGHUP: 2 of 4 safe" in said and "NOT MEASURED: 2 of 4" in said and "2/4" in said
    assert measure_safety(4, only=["SIGHUP"], robots=("duck",))["met"] is False


def test_nothing_planned_is_not_met_and_all_measured_and_safe_is(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def one(name: str, row: Ending, moment: Moment) -> Verdict:
        return Verdict(moment.activity, moment.after, 0.1, 130, "off", "")

    monkeypatch.setattr(bench, "_one", one)
    assert measure_safety(2, only=["stop button"], robots=("op3",))["met"] is True
    assert measure_safety(2, only=["stop button"], robots=("duck",))["met"] is False


def test_a_row_that_is_not_there_is_refused() -> None:
    with pytest.raises(UsageError, match="no row begins with SIGFOO"):
        measure_safety(1, only=["SIGFOO"])
