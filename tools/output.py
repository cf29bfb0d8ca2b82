"""What people read (standard error) and what programs read (JSON)."""

import json
import sys
from math import isfinite
from os import W_OK, access
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

from hal.errors import UsageError, WindupError
from tools.run_notes import NOTES

SCHEMA = 1
console = Console(stderr=True, highlight=False)


def plain(value: Any) -> Any:
    """Return `value` in plain JSON types; numbers that are none become null."""
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float):
        return round(value, 6) if isfinite(value) else None
    return value


def check_writable(*targets: Path | None) -> None:
    """Raise before anything runs if one of the result files could not be written.

    Raises:
        UsageError: The folder is missing or may not be written.
    """
    for target in targets:
        if target is None or str(target) == "-":
            continue
        folder = target.resolve().parent
        if not folder.is_dir():
            raise UsageError(f"{target} cannot be written: there is no folder {folder}")
        if not access(folder, W_OK) or (target.exists() and not access(target, W_OK)):
            raise UsageError(f"{target} cannot be written: permission denied")


def write_json(target: Path | None, command: str, result: dict[str, Any]) -> None:
    """Write one JSON object to `target`: a file, standard output for "-", or nowhere for None.

    Where a robot was run, what there was to warn about, and what the driver of its servos has
    clamped, are part of it.
    """
    if target is None:
        return
    whole = {"schema": SCHEMA, "command": command, **result}
    if NOTES.ran:
        whole["warnings"] = NOTES.records()
        whole["driver_clamps"] = NOTES.driver_clamps
    text = json.dumps(plain(whole), indent=2)
    if str(target) == "-":
        sys.stdout.write(text + "\n")
        return
    target.write_text(text + "\n", encoding="utf-8")


def error_record(error: WindupError) -> dict[str, Any]:
    """Return an error as programs read it."""
    kind = type(error).__name__.removesuffix("Error")
    return {"error": {"kind": kind, "message": str(error), "exit_status": error.exit_status}}
