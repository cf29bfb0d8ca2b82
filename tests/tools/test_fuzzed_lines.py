"""Whatever a command line says, and wherever its results go: an error of ours, or none."""

import io
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import hal.open_port
import sim_twin.wire.emulate
import sim_twin.wire.worlds
from hal.errors import PortError
from sim_twin.twin import Twin
from tools import cli
from tools.command_table import COMMANDS

LONG = ("bench", "reproduce", "sweep", "synthesise", "health")
"""Commands that run for long without a port or a twin, or look at what others run."""
ROBOTS = ("op3", "duck", "human", "opp3", "", "/", "..", "-", "x" * 300, "/dev/null", "ü")
URLS = (
    "twin://op3",
    "twin://op3?latency=nan",
    "twin://bench?servos=XM430-W350:1-1000000000",
    "twin:///etc",
    "twin://[",
    "twin://",
    "twin://op3?=&&?",
    "://",
    "socket://[::1",
    "socket://a:b",
    "usb:",
    "body=twin://op3,,=",
    "/dev/zero",
    "",
)
VALUES = (
    *("nan", "-inf", "-1", "0", "3", "0.5", "1e308", "9" * 5000, "1000000000", "true", ""),
    *("=", "a=1", "a=nan@1:2", "speed=0:1:1000000000", "speed=0:1:3", ",", "circle:nan", "0,0,1"),
    *("/dev/zero", "/dev/full", "/dev/null", ".", "none/x.json", "x" * 300, "a.csv", "a.toml"),
    *("a.png", "stand", "left", "hold", "front", "walk", "op3", "*"),
)
OPTIONS = {
    name: [f"--{field.name.replace('_', '-')}" for field in fields(entry.load())]
    for name, entry in COMMANDS.items()
}


@pytest.fixture
def nothing_runs(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Let every port and every world be one that cannot be opened."""

    def refuse(*_: object, **__: object) -> None:
        raise PortError("there is nothing to open in this test")

    monkeypatch.setattr(hal.open_port, "_open", refuse)
    monkeypatch.setattr(sim_twin.wire.worlds, "build_world", refuse)
    monkeypatch.setattr(sim_twin.wire.emulate, "build_world", refuse)
    monkeypatch.setattr(Twin, "__init__", refuse)
    for name in LONG:
        monkeypatch.setattr(COMMANDS[name].load(), "run", lambda self: 0)
    monkeypatch.chdir(tmp_path)


@st.composite
def lines(draw: st.DrawFn) -> list[str]:
    """Return a command with a robot, and options of its with any values."""
    name = draw(st.sampled_from(sorted(OPTIONS)))
    words = [name, *draw(st.lists(st.sampled_from(ROBOTS), max_size=2))]
    for _ in range(draw(st.integers(0, 3))):
        words.append(draw(st.sampled_from(OPTIONS[name])))
        values = URLS if words[-1] in ("--port", "--url") else VALUES
        words += draw(st.lists(st.sampled_from(values), max_size=2))
    return words


@pytest.fixture
def signals_kept() -> Iterator[None]:
    import signal

    before = signal.getsignal(signal.SIGTERM)
    yield
    signal.signal(signal.SIGTERM, before)


@pytest.mark.usefixtures("nothing_runs", "signals_kept")
@given(words=lines())
def test_every_command_line_ends_with_a_status_of_ours(words: list[str]) -> None:
    out, err = io.StringIO(), io.StringIO()
    with pytest.MonkeyPatch.context() as streams:
        streams.setattr(sys, "stdout", out)
        streams.setattr(sys, "stderr", err)
        status = cli.run(words)
    assert status in (0, 1, 2, 3), words
    assert "Traceback" not in err.getvalue()
    if status:
        assert sum(line.startswith("windup: ") for line in err.getvalue().splitlines()) == 1


HUNGRY = [
    "walk op3 --path /dev/zero",
    "footprints op3 /dev/zero",
    "walk op3 --seeds 1000000000",
    "walk op3 --gait /dev/zero",
    "walk op3 --learn /dev/zero",
    "scan twin://bench?servos=XM430-W350:1-1000000000",
    "scan twin://op3?latency=nan",
    "emulate twin://bench?servos=XM430-W350:1-1000000000 --tcp 0",
    "sweep walk op3 --grid speed=0:1:1000000000 --out a.csv",
    "sweep walk op3 --grid speed=0:1:9999 --grid side=0:1:9999 --seeds 99999 --out a.csv",
    "sweep walk op3 --out /dev/zero",
    "stand op3 --seconds 1e300",
    "walk op3 --steps 1000000000",
]
PROGRAM = """
import resource, sys
from tools import cli
from tools.command_table import COMMANDS
resource.setrlimit(resource.RLIMIT_DATA, (2**30, 2**30))
print([cli.run(line.split()) for line in sys.argv[1:]])
"""


def test_nothing_is_read_or_made_past_a_gigabyte(tmp_path: Path) -> None:
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM, *HUNGRY],
        cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert run.stdout.strip() == str([2] * len(HUNGRY)), run.stderr
    assert run.stderr.count("windup: ") == len(HUNGRY)


class Full(io.StringIO):
    def write(self, text: str) -> int:
        raise OSError(28, "No space left on device")


class Broken(io.StringIO):
    def write(self, text: str) -> int:
        raise BrokenPipeError(32, "Broken pipe")


STREAMS: dict[str, Any] = {"open": io.StringIO, "full": Full, "gone": Broken, "closed": type(None)}
TARGETS = ("", "-", "result.json", "/dev/full", ".", "none/result.json")
SHORT = ("robots", "stand op3 --seconds 0.02", "stop op3 --port twin://op3?physics=inertia")


@pytest.mark.usefixtures("signals_kept")
@pytest.mark.parametrize("err", STREAMS)
@pytest.mark.parametrize("out", STREAMS)
@pytest.mark.parametrize("target", TARGETS)
def test_every_output_that_fails_is_told_and_loses_nothing_else(
    target: str, out: str, err: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    line = SHORT[(TARGETS.index(target) + len(out) + len(err)) % len(SHORT)]
    streams = {name: STREAMS[kind]() for name, kind in (("stdout", out), ("stderr", err))}
    for name, stream in streams.items():
        monkeypatch.setattr(sys, name, stream)
    status = cli.run([*line.split(), *(["--json", target] if target else [])])
    good = target in ("", "result.json") or (target == "-" and out == "open")
    early = target in (".", "none/result.json") or (target == "-" and out == "closed")
    assert status == (0 if good else 2 if early else 1)
    if err == "open":
        said = streams["stderr"].getvalue()
        told = sum(line.startswith("windup: ") for line in said.splitlines())
        assert told == (0 if good or (target == "-" and out == "gone") else 1)
        assert early or "op3" in said  # the figures
