import os
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from windup.hal.stopping.process_start import process_start
from windup.hal.stopping.stop_flag import (
    TIME_TO_ANSWER,
    About,
    Outcome,
    StopFlag,
    flags_in,
    remove_leftovers,
)

OFF = Outcome(said="torque is off")


@pytest.fixture
def flags(tmp_path: Path) -> Iterator[tuple[StopFlag, StopFlag]]:
    """The flag of a run, and the same as another process sees it."""
    run = StopFlag.create("op3", "/dev/ttyUSB0", tmp_path)
    other = StopFlag.open(run.path)
    assert other is not None
    yield run, other
    other.close()
    run.remove()


def test_another_process_sees_what_the_run_is_about(flags: tuple[StopFlag, StopFlag]) -> None:
    _, other = flags
    assert other.about == About("op3", "/dev/ttyUSB0")
    assert (other.pid, other.alive, other.guardian) == (os.getpid(), True, 0)
    assert other.path.stat().st_mode & 0o777 == 0o600


def test_a_request_is_seen_and_carried_out_once(flags: tuple[StopFlag, StopFlag]) -> None:
    run, other = flags
    assert not run.asked()
    stamp = other.request()
    assert not other.seen(stamp)
    assert run.asked() and other.seen(stamp) and not other.done(stamp)
    run.finish(OFF)
    assert other.done(stamp) and other.outcome == OFF
    assert not run.asked()


def test_a_further_request_during_a_stop_is_one_for_haste(
    flags: tuple[StopFlag, StopFlag],
) -> None:
    run, other = flags
    first = other.request()
    assert run.asked() and not run.again()
    second = other.request()
    assert run.again()
    run.finish(OFF)
    assert other.done(first) and other.done(second) and not run.asked()


def test_only_a_request_that_nobody_sees_is_overdue(
    flags: tuple[StopFlag, StopFlag], monkeypatch: pytest.MonkeyPatch
) -> None:
    run, other = flags
    assert not other.overdue()
    now = other.request()
    assert not other.overdue()
    monkeypatch.setattr("time.monotonic_ns", lambda: now + TIME_TO_ANSWER + 1)
    assert other.overdue()
    assert not other.overdue(since=now + 2)  # a guardian that has just started
    assert run.asked() and not other.overdue()


def test_a_request_to_a_run_that_ends_is_answered(tmp_path: Path) -> None:
    run = StopFlag.create("op3", None, tmp_path)
    other = StopFlag.open(run.path)
    assert other is not None
    stamp = other.request()
    run.remove()
    assert other.done(stamp) and other.outcome is not None
    assert "has ended by itself" in other.outcome.said
    other.close()
    assert flags_in(tmp_path) == []


def test_a_flag_stays_while_a_guardian_goes_on_with_it(tmp_path: Path) -> None:
    run = StopFlag.create("op3", None, tmp_path)
    run.guardian = os.getppid()
    other = StopFlag.open(run.path)
    assert other is not None
    stamp = other.request()
    run.remove()
    assert other.path.exists() and not other.done(stamp)
    other.finish(OFF)
    assert other.done(stamp)
    other.close()


def test_flags_of_dead_processes_are_removed(tmp_path: Path) -> None:
    run = StopFlag.create("op3", None, tmp_path)
    with subprocess.Popen(["sleep", "0"]) as dead:
        dead.wait()
        run._words[1] = dead.pid
    remove_leftovers(tmp_path)
    assert list(tmp_path.iterdir()) == []
    run.close()


def test_two_runs_of_one_robot_have_a_flag_each(tmp_path: Path) -> None:
    runs = [StopFlag.create("op3", None, tmp_path) for _ in range(2)]
    found = flags_in(tmp_path)
    assert len(found) == 2
    for flag in (*found, *runs):
        flag.close()


@pytest.mark.parametrize("size", [0, 7, 16384])
def test_other_files_are_no_flags(tmp_path: Path, size: int) -> None:
    (tmp_path / "op3.1.0.stop").write_bytes(bytes(size))
    assert flags_in(tmp_path) == []


def test_a_process_that_has_ended_has_no_start() -> None:
    assert process_start(os.getpid()) > 0
    with subprocess.Popen(["sleep", "0"]) as dead:
        os.waitid(os.P_PID, dead.pid, os.WEXITED | os.WNOWAIT)
        assert process_start(dead.pid) == 0  # still in the table of processes
