"""Runs a script that uses a package which lies beside the environment."""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[4]


def run_client(
    name: str, *arguments: str, package: str | None = None, paths: Sequence[Path] = ()
) -> Any:
    """Return what the script ``NAME_client`` printed last, as JSON.

    Args:
        name: Which script of this folder.
        *arguments: Its arguments.
        package: Folder beside the environment's packages, see the Makefile; None: it needs none.
        paths: Further folders to import from.
    """
    beside = [] if package is None else [Path(sys.prefix) / package]
    for folder in beside:
        assert folder.is_dir(), f"{package} is not installed: run `make .venv/clients.stamp`"
    ran = subprocess.run(
        [sys.executable, "-m", f"tests.sim_twin.wire.clients.{name}_client", *arguments],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(map(str, (*beside, *paths)))},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=110,
    )
    assert ran.returncode == 0, ran.stderr
    return json.loads(ran.stdout.splitlines()[-1])
