"""Output for people (on standard error) and for programs (JSON)."""

import json
from math import isfinite
from pathlib import Path
from typing import IO, Any, cast

import numpy as np
from rich.console import Console

from windup.hal.errors import WindupError
from windup.tools.terminal.result import SCHEMA, print_result
from windup.tools.terminal.run_notes import NOTES
from windup.tools.terminal.streams import StandardError
from windup.tools.terminal.writing import STANDARD_OUTPUT, writing

console = Console(file=cast(IO[str], StandardError()), highlight=False)


def to_json_types(value: Any) -> Any:
    """Return `value` in plain JSON types; NaN and infinity become null."""
    if isinstance(value, dict):
        return {str(key): to_json_types(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [to_json_types(item) for item in value]
    if isinstance(value, np.ndarray):
        return to_json_types(value.tolist())
    if isinstance(value, np.generic):
        return to_json_types(value.item())
    if isinstance(value, float):
        return round(value, 6) if isfinite(value) else None
    return value


def write_json(target: Path | None, command: str, result: dict[str, Any]) -> None:
    """Write one JSON object to `target`: a file, standard output for "-", or nowhere for None.

    If a robot was run, the object includes the warnings of the run and the clamp counts of the
    servo driver. A failure to write is reported at the end of the command, and makes its exit
    status 1.
    """
    if target is None:
        return
    whole = {"schema": SCHEMA, "command": command, **result}
    if NOTES.ran:
        whole["warnings"] = NOTES.records()
        whole["driver_clamps"] = NOTES.driver_clamps
    text = json.dumps(to_json_types(whole), indent=2)
    with NOTES.collecting_output_errors():
        if target == STANDARD_OUTPUT:
            print_result(text + "\n")
            return
        with writing(target):
            target.write_text(text + "\n", encoding="utf-8")


def error_record(error: WindupError) -> dict[str, Any]:
    """Return an error as a record for JSON."""
    kind = type(error).__name__.removesuffix("Error")
    return {"error": {"kind": kind, "message": str(error), "exit_status": error.exit_status}}
