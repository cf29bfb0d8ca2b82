"""Signals that would end or stop a guardian, at any time of its life."""

import os
import signal
import subprocess
import threading
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.hal.guardian.two_servos import TORQUE, host, record, show, switch_on, wait_for_end
from windup.hal.guardian import handle
from windup.hal.guardian.handle import Guardian
from windup.hal.guardian.launch import launch
from windup.hal.guardian.signals import IGNORED, signals_blocked


def send_all(number: int) -> None:
    for each in sorted(IGNORED):
        os.kill(number, each)


def test_what_ends_a_service_or_a_terminal_is_ignored() -> None:
    ends = {"TERM", "INT", "HUP", "QUIT", "PIPE", "TSTP", "TTOU", "TTIN", "USR1", "ALRM", "XCPU"}
    assert {signal.Signals[f"SIG{each}"] for each in ends} <= IGNORED


def test_a_guardian_that_only_starts_ignores_them(
    sts_bus: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def launch_and_send(locks: Sequence[int]) -> "subprocess.Popen[bytes]":
        process = launch(locks)
        send_all(process.pid)
        return process

    monkeypatch.setattr(handle, "launch", launch_and_send)
    guardian = Guardian([record(sts_bus)], "limp")
    assert guardian.alive
    guardian.release()
    assert guardian._process.returncode == 0


def test_a_guardian_that_watches_ignores_them(sts_bus: Path) -> None:
    guardian = Guardian([record(sts_bus)], "limp")
    send_all(guardian.pid)
    switch_on(sts_bus)
    guardian.release()
    assert guardian._process.returncode == 0
    assert show(sts_bus, TORQUE) == [1, 1]


def test_a_guardian_that_stops_a_robot_ignores_them(sts_bus: Path) -> None:
    with host(sts_bus, "hold", 0.5) as (program, guardian):
        program.kill()
        assert program.stderr is not None
        for line in program.stderr:
            if "holds its pose" in line:
                break
        send_all(guardian)
        assert "torque is off at all servos, read back" in program.stderr.read()
        wait_for_end(guardian)
    assert show(sts_bus, TORQUE) == [0, 0]


def test_signals_to_this_process_wait_while_it_starts_one() -> None:
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt), signals_blocked():
            signal.pthread_kill(threading.get_ident(), signal.SIGINT)
            reached = True
    finally:
        signal.signal(signal.SIGINT, before)
    assert reached
