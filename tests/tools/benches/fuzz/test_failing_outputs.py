"""Wherever results go, and whatever fails there: it is told, and nothing else is lost."""

import io
import sys
from pathlib import Path
from typing import Any

import pytest

from windup.tools import cli


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
