"""Any command with any of its options and odd values, where nothing runs: one line, or none."""

import io
import random
import sys
from dataclasses import fields
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import windup.hal.port.open_port
import windup.hal.stopping.folder
import windup.sim_twin.wire.serve.emulate
import windup.sim_twin.wire.world.worlds
from windup.hal.errors import PortError
from windup.sim_twin.twin import Twin
from windup.tools import cli
from windup.tools.benches.fuzz import odd_line
from windup.tools.benches.fuzz.odd_line import any_line
from windup.tools.command_line.table import COMMANDS

LONG = ("bench", "reproduce", "sweep", "synthesise", "health")
"""Commands that run for long without a port or a twin, or look at what others run."""
OPTIONS = {
    name: [f"--{field.name.replace('_', '-')}" for field in fields(entry.load())]
    for name, entry in COMMANDS.items()
}


@pytest.fixture
def nothing_runs(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Let every port and every world be one that cannot be opened."""

    def refuse(*_: object, **__: object) -> None:
        raise PortError("there is nothing to open in this test")

    monkeypatch.setattr(windup.hal.port.open_port, "_open", refuse)
    monkeypatch.setattr(windup.sim_twin.wire.world.worlds, "build_world", refuse)
    monkeypatch.setattr(windup.sim_twin.wire.serve.emulate, "build_world", refuse)
    monkeypatch.setattr(Twin, "__init__", refuse)
    monkeypatch.setattr(windup.hal.stopping.folder, "BASE", tmp_path)  # `stop --all` finds none
    for name in LONG:
        monkeypatch.setattr(COMMANDS[name].load(), "run", lambda self: 0)
    monkeypatch.chdir(tmp_path)


@pytest.mark.usefixtures("nothing_runs", "signals_kept")
@given(seed=st.integers(0, 10**9))
def test_every_command_line_ends_with_a_status_of_ours(seed: int) -> None:
    words = any_line(random.Random(seed), OPTIONS)
    out, err = io.StringIO(), io.StringIO()
    with pytest.MonkeyPatch.context() as streams:
        streams.setattr(sys, "stdout", out)
        streams.setattr(sys, "stderr", err)
        status = cli.run(words)
    assert status in (0, 1, 2, 3), words
    assert "Traceback" not in err.getvalue(), words
    if status:
        told = [line for line in err.getvalue().splitlines() if line.startswith("windup: ")]
        assert len(told) == 1, words


def test_the_options_of_odd_runs_are_those_of_their_commands() -> None:
    for name, options in (odd_line.OWN | odd_line.WORDS).items():
        assert set(options.split()) <= set(OPTIONS[name])
    for name in set(odd_line.SHORT) - {"health"}:
        assert any(option in OPTIONS[name] for option in odd_line.NUMBERS)
