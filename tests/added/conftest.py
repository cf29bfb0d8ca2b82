"""A package of somebody else with servos and a robot, installed into a temporary folder."""

import os
import shutil
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess, run
from sys import executable

import pytest

from tests.added.install import install
from tests.tools.conftest import shell

__all__ = ["acme", "acme_folder", "python", "shell"]

HERE = Path(__file__).parent
GROUPS = {
    "windup.servos": {"acme": "acme_servos.family:FAMILY"},
    "windup.robots": {"acme_arm": "acme_robots.acme_arm"},
}
Python = Callable[..., "CompletedProcess[str]"]


@pytest.fixture(scope="session")
def acme_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    for package in ("acme_servos", "acme_robots"):
        shutil.copytree(HERE / package, folder / package)
    install(folder, "windup-acme", GROUPS)
    return folder


@pytest.fixture
def acme(acme_folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.syspath_prepend(acme_folder)
    return acme_folder


@pytest.fixture
def python(tmp_path: Path) -> Python:
    """Run a program in an interpreter that finds the packages of some folders."""

    def program(text: str, *folders: Path) -> "CompletedProcess[str]":
        path = os.pathsep.join(map(str, (HERE.parents[1], *folders)))
        return run([executable, "-c", text], capture_output=True, text=True, timeout=100,
                   cwd=tmp_path, env={**os.environ, "PYTHONPATH": path})  # fmt: skip

    return program
