"""The PYTHONPATH of a child: our package, and not the working folder by an empty entry."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from windup.hal.guardian.child_path import child_python_path


def test_the_working_folder_is_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "socket.py").write_text("raise SystemExit('the wrong socket')")
    monkeypatch.setattr(sys, "path", ["", *sys.path])
    subprocess.run(
        [sys.executable, "-P", "-c", "import socket, windup.hal"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": child_python_path()},
        check=True,
    )


def test_our_package_is_found_without_an_entry_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", ["", "/nowhere"])
    nowhere, home = child_python_path().split(os.pathsep)
    assert nowhere == "/nowhere"
    assert (Path(home) / "windup" / "hal").is_dir()
