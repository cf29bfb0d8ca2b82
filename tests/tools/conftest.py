import json
import shutil
import signal
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from robots import RobotDescription
from tools import cli


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
def windup(capsys: pytest.CaptureFixture[str]) -> Iterator[Windup]:
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
def my_op3(op3: RobotDescription, tmp_path: Path) -> Path:
    return Path(shutil.copytree(op3.folder, tmp_path / "my_op3"))


@pytest.fixture
def my_human(human: RobotDescription, tmp_path: Path) -> Path:
    return Path(shutil.copytree(human.folder, tmp_path / "my_human"))
