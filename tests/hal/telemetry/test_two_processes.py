"""A ring that one process writes and another one reads at the same time."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.hal.telemetry.small_ring import ring, write
from windup.hal.telemetry.reader import TelemetryReader, Ticks

TICKS = 20_000
WRITE = """
import sys
from pathlib import Path
from tests.hal.telemetry.small_ring import ring, write
writer = ring(Path(sys.argv[1]), rate=1.0)
writer.begin()
print("ready", flush=True)
write(writer, range(1, int(sys.argv[2]) + 1))
writer.end("done")
"""


@pytest.fixture
def started(tmp_path: Path) -> subprocess.Popen[str]:
    """A process that writes a ring of 8 records as fast as it can."""
    command = [sys.executable, "-c", WRITE, str(tmp_path), str(TICKS)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    return process


def check(ticks: Ticks) -> None:
    """Assert that each tick is of one piece."""
    k = ticks["tick"]
    assert (ticks["sequence"] == k).all()
    np.testing.assert_array_equal(ticks["time"], 0.1 * k)
    np.testing.assert_array_equal(ticks["applied"][:, 0], np.stack([k, k], axis=-1))
    np.testing.assert_array_equal(ticks["asked"][:, 0, 1], 0.01 * k)


def test_a_reader_gets_whole_ticks_in_order_and_knows_how_many_it_lost(
    started: subprocess.Popen[str], tmp_path: Path
) -> None:
    seen: list[int] = []
    with TelemetryReader(tmp_path / "duo.ring") as reader:
        while True:
            over = reader.ended is not None
            ticks = reader.take()
            check(ticks)
            seen += ticks["tick"].tolist()
            if over:
                break
        lost = reader.lost
    assert started.wait() == 0
    assert (np.diff(seen) > 0).all()
    assert seen[-1] == TICKS
    assert len(seen) + lost == TICKS


def test_the_ring_of_a_killed_writer_holds_whole_ticks_up_to_the_last(
    started: subprocess.Popen[str], tmp_path: Path
) -> None:
    with TelemetryReader(tmp_path / "duo.ring") as reader:
        while reader.sequence < 100:
            pass
        os.kill(started.pid, signal.SIGKILL)
        started.wait()
        ticks = reader.since()
        check(ticks)
        newest = reader.sequence
        assert ticks["tick"][-1] == newest
        assert len(ticks) in (7, 8), "at most the record that was being written is missing"
        assert reader.ended is None and not reader.closed
        assert len(reader.take()) + reader.lost == newest


def test_a_reader_that_is_too_slow_does_not_hold_up_the_writer(tmp_path: Path) -> None:
    writer = ring(tmp_path)
    with TelemetryReader(writer.path) as reader:
        write(writer, range(1, 4))
        assert reader.take()["tick"].tolist() == [1, 2, 3]
        write(writer, range(4, 31))
        assert reader.take()["tick"].tolist() == list(range(23, 31))
        assert reader.lost == 19
