import io
import json
import shutil
import signal
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from windup.robots import RobotDescription
from windup.sim_twin.twin import Twin
from windup.tools import cli


@dataclass(frozen=True)
class Ran:
    """What a `windup` command left behind."""

    status: int
    out: str
    err: str

    @property
    def json(self) -> dict[str, Any]:
        found: dict[str, Any] = json.loads(self.out)
        return found


Windup = Callable[..., Ran]


@pytest.fixture
def shell(capsys: pytest.CaptureFixture[str]) -> Iterator[Windup]:
    before = signal.getsignal(signal.SIGTERM)

    def command(*arguments: object) -> Ran:
        capsys.readouterr()
        try:
            status = cli.run([str(argument) for argument in arguments])
        except SystemExit as left:
            status = int(left.code or 0)
        said = capsys.readouterr()
        return Ran(status, said.out, said.err)

    yield command
    signal.signal(signal.SIGTERM, before)


@pytest.fixture
def nothing_opens(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    """Let no port be opened and no world be built."""

    def opened(*arguments: object, **named: object) -> None:
        raise AssertionError(f"opened: {arguments} {named}")

    monkeypatch.setattr("windup.hal.port.open_port._open", opened)
    monkeypatch.setattr("windup.sim_twin.wire.world.worlds.build_world", opened)
    monkeypatch.setattr(Twin, "__init__", opened)
    monkeypatch.chdir(tmp_path)
    before = signal.getsignal(signal.SIGTERM)
    yield
    signal.signal(signal.SIGTERM, before)


def refusal(words: list[str]) -> str:
    """Return the one line with which a command line is refused."""
    said = io.StringIO()
    with redirect_stderr(said):
        status = cli.run(words)
    lines = said.getvalue().splitlines()
    assert (status, len(lines)) == (2, 1), said.getvalue()
    assert lines[0].startswith("windup: ")
    return lines[0]


@pytest.fixture
def my_op3(op3: RobotDescription, tmp_path: Path) -> Path:
    return Path(shutil.copytree(op3.folder, tmp_path / "my_op3"))


@pytest.fixture
def my_human(human: RobotDescription, tmp_path: Path) -> Path:
    return Path(shutil.copytree(human.folder, tmp_path / "my_human"))
