import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.hal.guardian.two_servos import ENVIRONMENT
from windup.hal.errors import PortError
from windup.hal.port import lock
from windup.hal.port.lock import AdapterLock, LockNote, wait_while_guarded, write_note

ACTING = """
import sys, time
from windup.hal.port.lock import AdapterLock, LockNote, write_note
number = AdapterLock(sys.argv[1]).acquire()
write_note(number, LockNote(1234, "switching the torque off"))
print("taken", flush=True)
time.sleep(0.3)
"""


@pytest.fixture
def device(tmp_path: Path) -> str:
    return str(tmp_path / "tty")


def test_one_lock_an_adapter(device: str) -> None:
    first = AdapterLock(device)
    first.acquire()
    with pytest.raises(PortError, match=f"another armed run \\(process {os.getpid()}\\)"):
        AdapterLock(device).acquire()
    first.close()
    second = AdapterLock(device)
    second.acquire()
    second.close()


def test_a_new_run_waits_while_a_guardian_acts_and_says_so(
    device: str, caplog: pytest.LogCaptureFixture
) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", ACTING, device], stdout=subprocess.PIPE, env=ENVIRONMENT
    ) as guardian:
        assert guardian.stdout is not None and guardian.stdout.readline() == b"taken\n"
        wait_while_guarded(device)
        assert AdapterLock(device).try_acquire()
    assert "waiting for the guardian of an earlier run (process 1234)" in caplog.text
    assert "switching the torque off" in caplog.text


def test_a_run_that_is_only_armed_is_not_waited_for(device: str) -> None:
    held = AdapterLock(device)
    write_note(held.acquire(), LockNote(1, ""))
    began = time.monotonic()
    wait_while_guarded(device)
    assert time.monotonic() - began < 5.0
    held.close()


def test_a_port_in_this_process_waits_for_no_lock_of_its_name(
    caplog: pytest.LogCaptureFixture,
) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", ACTING, "twin://op3"], stdout=subprocess.PIPE, env=ENVIRONMENT
    ) as somebody:
        assert somebody.stdout is not None and somebody.stdout.readline() == b"taken\n"
        wait_while_guarded("twin://op3")
    assert caplog.text == ""


def test_a_lock_has_no_number_of_a_standard_stream(
    device: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lock, "RESERVED", 300)
    held = AdapterLock(device)
    assert held.acquire() >= 300
    assert not AdapterLock(device).try_acquire()
    held.close()


def test_a_note_replaces_a_longer_one(device: str) -> None:
    held = AdapterLock(device)
    number = held.acquire()
    for note in (LockNote(1, "r_knee, " * 500), LockNote(2, "")):
        write_note(number, note)
        assert held.note() == note
    held.close()


def test_a_lock_that_was_let_go_does_not_close_the_next_file_of_its_number(device: str) -> None:
    held = AdapterLock(device)
    number = held.acquire()
    held.close()
    assert os.dup2(0, number) == number
    held.close()
    os.close(number)
