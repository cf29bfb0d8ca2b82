"""Wu & Zordan's statements judged on made-up results, and the shortest real run of each kind."""

from typing import Any

import pytest

from windup.tools.reproduce.study.figure import Figure, Job, Result
from windup.tools.reproduce.wu_zordan import WU_ZORDAN, pendulum, reactive
from windup.tools.reproduce.wu_zordan.jobs import push, turn
from windup.tools.reproduce.wu_zordan.work import work


def fake_result(job: Job, good: bool = True) -> Result:
    """Return a run as the paper has it, or one that says the opposite."""
    options: dict[str, Any] = dict(job.options)
    if job.kind != "push":
        place = {"x": 0.1, "y": 0.2, "yaw_deg": 0.0}
        return {
            "steps": options["steps"],
            "stepped": options["steps"] if good else 1,
            "largest_away_m": 0.01 if good else 0.1,
            "largest_turned_deg": 1.0,
            "seconds": 9.0,
            "falls": [{"wanted": place, "place": place}] if good else [],
            "turned": options.get("angle", 0.0),
        }
    force, momentum = options["force"], options["way"] == "momentum"
    steps = int(force > 60.0 and options["way"] != "feet")
    stands = force <= 170.0 or momentum
    return {
        "directions": options["directions"],
        "force": force,
        "survived": stands if good else not momentum,
        "steps": steps,
        "begun": [0.03 if momentum == good else 0.05] * steps,
    }


@pytest.mark.parametrize("figure", WU_ZORDAN.figures, ids=lambda figure: figure.name)
@pytest.mark.parametrize(("quick", "good"), [(True, True), (True, False), (False, True)])
def test_every_statement_is_drawn_and_judged(figure: Figure, quick: bool, good: bool) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    results = {job: fake_result(job, good) for job in figure.jobs(quick)}
    assert set(figure.jobs(True)) <= set(figure.jobs(False))
    canvas = pyplot.figure()
    figure.draw(canvas, results)
    pyplot.close(canvas)
    claims = figure.claims(results)
    assert all(claim.agrees in (good, None) for claim in claims if not claim.own)
    assert not good or all(claim.agrees is not False for claim in claims)
    assert all(claim.ours and claim.criterion for claim in claims)
    assert all(len(row) == len(t.header) for t in figure.table(results) for row in t.rows)


def test_the_full_report_leaves_nothing_open() -> None:
    for module in (reactive, pendulum):
        results = {job: fake_result(job) for job in module.jobs(False)}
        assert [claim.agrees for claim in module.claims(results)].count(None) == 0


def test_a_push_notes_when_its_steps_begin_and_a_turn_where_feet_come_down() -> None:
    pushed = work(push(400.0, [0.0]))
    assert pushed["survived"]
    assert len(pushed["begun"]) == pushed["steps"] > 0
    assert 0.0 < pushed["begun"][0] < 0.1
    turned = work(turn("human", 2, 30.0))
    assert (turned["stepped"], turned["turned"]) == (2, 30.0)
    assert turned["largest_turned_deg"] < 5.0
