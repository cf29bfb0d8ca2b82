"""Writes gait files as TOML, without values that equal the format's defaults."""

from pathlib import Path
from typing import Any

import msgspec

from windup.control.pose_graph.gait_file import GaitFile
from windup.hal.errors import UsageError
from windup.tools.terminal.writing import writing


def write_gait(path: Path, file: GaitFile) -> None:
    """Write a gait file for `windup walk ROBOT --gait PATH`.

    Raises:
        UsageError: tomli-w is not installed.
        OutputError: The file cannot be written.
    """
    try:
        import tomli_w
    except ImportError:
        raise UsageError(
            "synthesis needs cma and tomli-w: pip install 'windup-robotics[synthesis]'"
        ) from None
    with writing(path):
        path.write_text(tomli_w.dumps(sparse(file)), encoding="utf-8")


def sparse(value: Any) -> Any:
    """Return a record as plain types, without the keys whose values equal their defaults."""
    if isinstance(value, msgspec.Struct):
        fields = msgspec.structs.fields(value)
        kept = {f.name: getattr(value, f.name) for f in fields}
        return {f.name: sparse(kept[f.name]) for f in fields if kept[f.name] != _default(f)}
    if isinstance(value, dict):
        return {key: sparse(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [sparse(item) for item in value]
    return value


def _default(field: msgspec.structs.FieldInfo) -> Any:
    if field.default_factory is not msgspec.NODEFAULT:
        return field.default_factory()
    return field.default
