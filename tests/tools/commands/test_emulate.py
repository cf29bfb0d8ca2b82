"""`windup emulate`, as a program of its own. Nothing here is timed."""

import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest
import serial

from tests.tools.conftest import Windup
from windup.sim_twin.wire.protocols.frames1 import encode
from windup.tools.cli import run

COMMAND = [sys.executable, "-c", "from windup.tools.cli import main; main()", "emulate"]
STS = "twin://bench?servos=STS3215:1-3"


def start(*arguments: str) -> "subprocess.Popen[str]":
    return subprocess.Popen([*COMMAND, *arguments], stderr=subprocess.PIPE, text=True)


def said(process: "subprocess.Popen[str]") -> list[str]:
    """Return what it says until it serves."""
    assert process.stderr is not None
    lines = []
    for line in process.stderr:
        lines.append(line.strip())
        if line.startswith("Ctrl-C"):
            break
    return lines


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_serves_until_told_to_end_and_leaves_nothing(number: int, tmp_path: Path) -> None:
    path = tmp_path / "bus"
    with start(STS, "--pty", str(path)) as process:
        assert said(process)[0] == (
            f"bus 'bench' (3 devices at 1000000 baud) on {path}; "
            f"try: windup scan {path} --baud 1000000"
        )
        with serial.Serial(str(path), 1_000_000, timeout=5.0) as port:
            port.write(encode(2, 1))
            assert port.read(6) == encode(2, 0)
        os.kill(process.pid, number)
        assert process.wait(20) == 0
    assert not path.exists()


def test_a_tcp_port_says_its_number() -> None:
    with start(STS, "--tcp", "0", "--faults", "drop:0") as process:
        (words, _) = said(process)
        url = words.split(" on ")[1].split(";")[0]
        assert url.startswith("socket://127.0.0.1:")
        with serial.serial_for_url(url, timeout=5.0) as port:
            port.write(encode(1, 1))
            assert port.read(6) == encode(1, 0)
        process.terminate()
        assert process.wait(20) == 0


def test_servos_need_no_robot() -> None:
    with start("--servos", "STS3215:1-6", "--tcp", "0") as process:
        lines = said(process)
        assert lines[0].startswith("bus 'bench' (6 devices at 1000000 baud) on socket://127.0.0.1:")
        assert len(lines) == 2  # no robot to run
        process.terminate()
        assert process.wait(20) == 0


def test_what_was_unplugged_can_be_opened_again(tmp_path: Path) -> None:
    path = tmp_path / "bus"
    with start(STS, "--pty", str(path), "--faults", "unplug:at=2:seconds=0.5") as process:
        said(process)
        with (
            serial.Serial(str(path), 1_000_000, timeout=0.1) as port,
            pytest.raises(serial.SerialException),
        ):
            while True:
                port.write(encode(1, 1))
                port.read(6)
        while not path.exists():
            pass
        with serial.Serial(str(path), 1_000_000, timeout=5.0) as port:
            port.write(encode(1, 1))
            assert port.read(6) == encode(1, 0)
        process.terminate()
        assert process.wait(20) == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([STS], "give either --pty PATH or --tcp PORT"),
        (["--tcp", "0"], "give either a ROBOT, or servos without one: --servos STS3215:1-6"),
        (["op3", "--servos", "STS3215:1", "--tcp", "0"], "give either a ROBOT, or servos"),
        (["--servos", "STS3215", "--tcp", "0"], "a model and its ids, as in 'XM430-W350:1-20'"),
        (["--servos", "STS3125:1", "--tcp", "0"], "unknown servo model 'STS3125'"),
        (["opp3", "--tcp", "0"], "unknown robot 'opp3'; did you mean 'op3'?"),
        (["op3", "--tcp", "0", "--faults", "dorp"], "unknown kind 'dorp'"),
        (["op3", "--tcp", "0", "--supply", "0"], "give more than 0, up to 60 V"),
        (["op3", "--tcp", "0", "--hand", "r_knee"], "a joint, degrees and seconds, as in"),
        (["op3", "--tcp", "0", "--hand", "r_kne:20:3s"], "did you mean 'r_knee'"),
        ([STS, "--pty", "/dev/null"], "/dev/null exists and is not the link of an emulated port"),
    ],
)
def test_what_cannot_be_is_said(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["emulate", *arguments]) == 2
    assert message in capsys.readouterr().err


def test_a_tcp_port_that_is_taken_is_one_line(shell: Windup) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        ran = shell("emulate", STS, "--tcp", taken.getsockname()[1])
    assert ran.status == 3
    assert "windup: cannot serve: Address already in use; give another --pty" in ran.err


def test_a_pty_in_no_folder_is_one_line(shell: Windup, tmp_path: Path) -> None:
    ran = shell("emulate", STS, "--pty", tmp_path / "none" / "bus")
    assert (ran.status, ran.err.count("\n")) == (2, 1)
    assert "cannot be written: there is no folder" in ran.err
