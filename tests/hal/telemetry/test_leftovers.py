import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

import windup.hal.telemetry.leftovers
from tests.hal.telemetry.small_ring import CONTACTS, guarded, write
from windup.hal.port.lock import AdapterLock
from windup.hal.telemetry.leftovers import FILES, KEPT, SPARE, process_runs, remove_leftovers
from windup.hal.telemetry.reader import TelemetryReader
from windup.hal.telemetry.writer import TelemetryWriter

Make = Callable[..., TelemetryWriter]
NOW = time.time()


@pytest.fixture
def dead() -> int:
    """A process that has ended."""
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


@pytest.fixture
def make(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Make:
    """Make a ring of a process, last written so many seconds ago."""

    def ring(name: str, pid: int | None = None, ago: float = 0.0) -> TelemetryWriter:
        path = tmp_path / f"{name}@twin.ring"
        with monkeypatch.context() as patch:
            if pid is not None:
                patch.setattr("windup.hal.telemetry.writer.os.getpid", lambda: pid)
            writer = TelemetryWriter(name, guarded(), CONTACTS, 1.0, path=path)
            patch.setattr("windup.hal.telemetry.writer.time.time", lambda: NOW - ago)
            write(writer, range(1, 3))
        return writer

    return ring


def left(folder: Path) -> set[str]:
    return {path.name.partition("@")[0] for path in folder.iterdir()}


def test_rings_of_dead_processes_go_after_an_hour(tmp_path: Path, make: Make, dead: int) -> None:
    make("old", dead, KEPT + 1.0)
    make("young", dead, KEPT - 60.0)
    remove_leftovers(tmp_path / "new@twin.ring", NOW)
    assert left(tmp_path) == {"young"}
    with TelemetryReader(tmp_path / "young@twin.ring") as reader:
        assert reader.sequence == 2, "`windup health` can still read it"


def test_rings_of_living_processes_stay_until_they_are_closed(tmp_path: Path, make: Make) -> None:
    make("open", ago=2.0 * KEPT).end("done")
    make("closed", ago=2.0 * KEPT).close()
    remove_leftovers(tmp_path / "new@twin.ring", NOW)
    assert left(tmp_path) == {"open"}


def test_the_ring_that_is_about_to_be_replaced_stays(tmp_path: Path, make: Make, dead: int) -> None:
    path = make("own", dead, KEPT + 1.0).path
    remove_leftovers(path, NOW)
    assert path.exists()


def test_of_many_rings_the_oldest_go_but_none_that_is_written(
    tmp_path: Path, make: Make, dead: int
) -> None:
    for number in range(FILES + 3):
        make(f"ring{number}", dead if number else None, ago=100.0 - number)
    remove_leftovers(tmp_path / "new@twin.ring", NOW)
    assert left(tmp_path) == {"ring0", *(f"ring{number}" for number in range(5, FILES + 3))}


def test_rings_of_too_many_bytes_go(
    tmp_path: Path, make: Make, dead: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    size = make("first", dead, 3.0).path.stat().st_size
    make("second", dead, 2.0)
    make("third", dead, 1.0)
    monkeypatch.setattr(windup.hal.telemetry.leftovers, "BYTES", 2 * size)
    remove_leftovers(tmp_path / "new@twin.ring", NOW)
    assert left(tmp_path) == {"second", "third"}


def test_what_a_dead_process_was_making_goes_at_once(tmp_path: Path, dead: int) -> None:
    for pid in (dead, os.getpid()):
        (tmp_path / f"op3@twin.{pid}").touch()
    remove_leftovers(tmp_path / "new@twin.ring", NOW)
    assert [path.name for path in tmp_path.iterdir()] == [f"op3@twin.{os.getpid()}"]


def test_a_file_that_is_no_ring_goes_as_an_old_ring_does(tmp_path: Path) -> None:
    for name, ago in (("old", KEPT + 1.0), ("young", 60.0)):
        path = tmp_path / f"{name}@twin.ring"
        path.write_bytes(b"of another version")
        os.utime(path, (NOW - ago, NOW - ago))
    remove_leftovers(tmp_path / "new@twin.ring", NOW)
    assert left(tmp_path) == {"young"}


def test_a_process_that_began_after_the_ring_is_another_one() -> None:
    assert process_runs(os.getpid())
    assert process_runs(os.getpid(), since=time.time())
    assert not process_runs(os.getpid(), since=time.time() - 1e6)


def test_a_lock_that_nobody_holds_goes_and_one_that_is_held_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    held, free = AdapterLock("socket://held:1"), AdapterLock("socket://free:1")
    held.acquire()
    remove_leftovers(tmp_path / "windup" / "new@twin.ring", time.time() + 2.0 * SPARE)
    assert len(list((tmp_path / "windup").iterdir())) == 1
    assert not AdapterLock("socket://held:1").try_acquire()
    free.acquire()
    assert not AdapterLock("socket://free:1").try_acquire(), "it was made anew"
    held.close()
    free.close()
