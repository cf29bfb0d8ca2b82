"""Emulated servos under a path, in a process that ends with its test. Nothing here is timed."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import serial

from windup.hal.errors import PortError, UsageError
from windup.sim_twin.wire.protocols.frames1 import encode
from windup.tools.testing import servo_pty
from windup.tools.testing.servo_pty import ServoPty

PATIENCE = 20.0  # s, for a busy machine
TORQUE_ON = encode(2, 3, bytes((40, 1)))
KILLED = """
import os, sys
from windup.tools.testing.servo_pty import ServoPty

pty = ServoPty(servos="STS3215:1", path=sys.argv[1])
os.kill(os.getpid(), 9)
"""


def opened(pty: ServoPty) -> serial.Serial:
    return serial.Serial(pty.path, 1_000_000, timeout=PATIENCE)


def test_a_program_finds_servos_under_a_path_and_nothing_is_left() -> None:
    with ServoPty(servos="STS3215:1-3") as pty, opened(pty) as port:
        port.write(encode(2, 1))
        assert port.read(6) == encode(2, 0)
        assert list(pty.paths) == ["bench"]
    assert not Path(pty.path).exists()
    with pytest.raises(UsageError, match="are closed"):
        pty.driven()


def test_it_says_how_many_motors_are_driven() -> None:
    with ServoPty(servos="STS3215:1-3") as pty, opened(pty) as port:
        assert pty.driven() == 0
        port.write(TORQUE_ON)
        port.read(6)
        assert pty.driven() == 1


def test_faults_begin_when_they_are_called_and_end_when_they_are_cleared() -> None:
    with ServoPty(servos="STS3215:1-3") as pty, opened(pty) as port:
        pty.faults.wrong_id(rate=1.0, ids=[1])
        port.write(encode(1, 1))
        assert port.read(6)[2] != 1
        pty.faults.clear()
        port.write(encode(1, 1))
        assert port.read(6) == encode(1, 0)
        pty.faults.overload(ids=[3])
        assert any(overloaded(port) for _ in range(1000))


def overloaded(port: serial.Serial) -> bool:
    port.write(encode(3, 1))
    return bool(port.read(6)[4] & 0x20)


def test_a_fault_that_cannot_happen_is_said() -> None:
    with ServoPty(servos="STS3215:1-3") as pty:
        with pytest.raises(UsageError, match="no servo has id 9; ids here: 1, 2, 3"):
            pty.faults.drop(ids=[9])
        assert pty.driven() == 0


def test_what_cannot_be_served_is_said(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="unknown servo model 'STS3125'"):
        ServoPty(servos="STS3125:1")
    (tmp_path / "taken").touch()
    with pytest.raises(UsageError, match="exists and is not the link of an emulated port"):
        ServoPty(servos="STS3215:1", path=tmp_path / "taken")


def test_it_ends_with_a_program_that_was_killed(tmp_path: Path) -> None:
    path = tmp_path / "bus"
    ran = subprocess.run([sys.executable, "-c", KILLED, str(path)], timeout=60)
    assert ran.returncode == -9
    deadline = time.monotonic() + PATIENCE
    while path.is_symlink():  # its end comes soon after
        assert time.monotonic() < deadline


def test_a_process_that_died_is_said_and_everything_is_closed() -> None:
    with ServoPty(servos="STS3215:1") as pty:
        folder = Path(pty.path).parent
        pty._process.kill()
        pty._process.wait()
        for _ in range(2):
            with pytest.raises(PortError, match=r"has ended \(exit status -9\)"):
                pty.driven()
        with pytest.raises(PortError, match="has ended"):
            pty.faults.clear()
    assert pty._process.stdout is not None and pty._process.stdout.closed
    assert not folder.exists()
    pty.close()


def test_one_that_is_silent_is_not_called_dead(monkeypatch: pytest.MonkeyPatch) -> None:
    with ServoPty(servos="STS3215:1") as pty:
        monkeypatch.setattr(servo_pty, "PATIENCE", 0.2)
        pty._process.send_signal(signal.SIGSTOP)
        with pytest.raises(PortError, match=r"runs, and has not answered for 0\.2 s"):
            pty.driven()
        monkeypatch.setattr(servo_pty, "PATIENCE", PATIENCE)
        with opened(pty) as port:
            pty._process.send_signal(signal.SIGCONT)
            port.write(encode(1, 3, bytes((40, 1))))
            port.read(6)
        assert pty.driven() == 1  # and not 0, the late answer


def test_a_robot_of_two_buses_has_two_paths() -> None:
    with ServoPty("duck", physics="inertia") as pty:
        assert list(pty.paths) == ["body", "imu"]
        with serial.Serial(pty.paths["imu"], 115_200, timeout=PATIENCE) as port:
            assert b"\xaa\xaa" in port.read(40)
