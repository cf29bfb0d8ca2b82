import multiprocessing
import time
from multiprocessing.connection import Connection

import pytest

from hal.errors import WindupError
from tools import bench_stop
from tools.bench_stop import measure_stops
from tools.stop_rig import Journal, Moment, NotMeasuredError, _hear

Pipe = tuple[Connection, Connection]


@pytest.fixture
def pipe() -> Pipe:
    return multiprocessing.Pipe(duplex=False)


def test_the_journal_knows_when_the_last_motor_was_let_go(pipe: Pipe) -> None:
    journal = Journal(pipe[0])
    for moment, driven in ((1.0, 14), (2.0, 3), (2.5, 0)):
        pipe[1].send((moment, driven))
    assert journal.wait_for(False, 0.0) == 1.0
    assert journal.wait_for(True, 0.0) == 2.5


def test_motors_that_stay_driven_are_not_taken_for_stopped(pipe: Pipe) -> None:
    journal = Journal(pipe[0])
    pipe[1].send((1.0, 14))
    pipe[1].send((2.0, 1))
    assert journal.wait_for(False, 0.0) == 1.0
    assert journal.wait_for(True, 0.0) is None


def test_a_run_says_what_it_does_why_it_failed_or_when_it_crashed(pipe: Pipe) -> None:
    said = time.monotonic()
    for message in (("doing", "playing"), ("crash", said), ("failed", "it ended by itself: fell")):
        pipe[1].send(message)
    assert _hear(pipe[0], 0.0) == "playing"
    assert _hear(pipe[0], 0.0) == said
    with pytest.raises(NotMeasuredError, match="fell"):
        _hear(pipe[0], 0.0)
    pipe[1].close()
    with pytest.raises(NotMeasuredError, match="gone"):
        _hear(pipe[0], 0.0)


def test_a_run_that_fails_by_itself_is_counted_and_done_anew(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seen: list[Moment] = []

    def end_one(name: str, moment: Moment) -> tuple[str, float]:
        seen.append(moment)
        if len(seen) == 2:
            raise NotMeasuredError("it fell")
        return "standing", [0.01, 0.0, 0.26, float("inf")][len(seen) - 1]

    monkeypatch.setattr(bench_stop, "end_one", end_one)
    result = measure_stops("duck", moments=3, ends=["SIGKILL"])["SIGKILL"]
    assert len({moment.after for moment in seen}) == 4
    assert result["off_in_time"] == 1  # 0.26 s is late, and never is later
    assert result["longest_s"] == float("inf")
    assert result["not_measured"] == {"it fell": 1}


def test_runs_that_only_fail_end_the_bench(monkeypatch: pytest.MonkeyPatch) -> None:
    def end_one(name: str, moment: Moment) -> tuple[str, float]:
        raise NotMeasuredError("the emulator does not start")

    monkeypatch.setattr(bench_stop, "end_one", end_one)
    with pytest.raises(WindupError, match="the emulator does not start"):
        measure_stops("duck", moments=3, ends=["SIGKILL"])
