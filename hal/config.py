"""Loads TOML strictly into typed records; the error names file, key and the likely spelling."""

import re
import tomllib
from collections.abc import Iterator
from math import isfinite
from pathlib import Path
from typing import Annotated, Any, Final, TypeVar

import msgspec
from msgspec import Meta

from windup.hal.errors import ConfigError, suggest
from windup.hal.key_mistakes import key_mistakes
from windup.hal.small_file import read_small

T = TypeVar("T")
LARGEST: Final = 1e12
"""Largest magnitude of any number in a file, in any unit."""
MOST_NAMED: Final = 12
"""Maximum number of missing keys that a message names."""

Positive = Annotated[float, Meta(gt=0.0)]
NotNegative = Annotated[float, Meta(ge=0.0)]
Fraction = Annotated[float, Meta(ge=0.0, le=1.0)]
Count = Annotated[int, Meta(ge=0, le=10_000)]
Seconds = Annotated[float, Meta(ge=0.0, le=86_400.0)]
Delay = Annotated[float, Meta(ge=0.0, le=1.0)]
Length = Annotated[float, Meta(gt=0.0, le=100.0)]
Tilt = Annotated[float, Meta(gt=0.0, le=4.0)]


class TomlRecord(msgspec.Struct, forbid_unknown_fields=True, frozen=True, kw_only=True):
    """Base class of every record that is read from a TOML file. An unknown key is an error."""


def load_toml(path: Path, record: type[T]) -> T:
    """Return the contents of the TOML file at `path` as a `record`.

    All numbers have to be finite: TOML allows `nan` and `inf`, but no key here does.

    Raises:
        ConfigError: The file is missing, is not TOML, or does not fit the record.
    """
    data = read_toml(path)
    check_finite(path, data)
    try:
        return msgspec.convert(data, record)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{path}: {_explain(str(error), record, data)}") from None


def read_toml(path: Path) -> dict[str, Any]:
    """Return the parsed TOML of the file at `path`.

    Raises:
        ConfigError: The file is missing, or is not TOML.
    """
    try:
        text = read_small(path).decode("utf-8-sig")  # Windows editors may write a BOM
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise ConfigError(f"{path}: not TOML: the text is not UTF-8") from None
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # numbers of 5000 digits, brackets 500 deep
        raise ConfigError(f"{path}: not TOML: {error}") from None


def check_finite(path: Path, data: Any) -> None:
    """Raise unless every number in the `data` of a file is finite.

    Raises:
        ConfigError: A number is not finite; the message names the file and the key.
    """
    for key, why in non_finite_numbers(data):
        raise ConfigError(f"{path}: {key}: {why}")


def non_finite_numbers(data: Any) -> Iterator[tuple[str, str]]:
    """Yield key and message of every number in `data` that is not finite, or too large."""
    for key, number in _numbers(data, ""):
        if not -LARGEST <= number <= LARGEST:
            infinite = isinstance(number, float) and not isfinite(number)
            problem = "not finite" if infinite else f"too large (maximum {LARGEST:g})"
            yield key, f"{number:g} is {problem}"


def _numbers(data: Any, key: str) -> Iterator[tuple[str, float]]:
    """Yield every number with its full key, such as `joint[3].lower`."""
    if isinstance(data, dict):
        for name, item in data.items():
            yield from _numbers(item, f"{key}.{name}" if key else name)
    elif isinstance(data, list):
        for index, item in enumerate(data):
            yield from _numbers(item, f"{key}[{index}]")
    elif isinstance(data, int | float):
        yield key, data


def _explain(message: str, record: type, data: Any) -> str:
    """Return the message for msgspec's `message`: the key first, then the likely spelling."""
    if "missing required field" in message:
        missing = [lost.key for lost in key_mistakes(data, record) if lost.kind == "missing"]
        more = f" and {len(missing) - MOST_NAMED} more" if len(missing) > MOST_NAMED else ""
        return f"missing: {', '.join(missing[:MOST_NAMED])}{more}"
    message = message.replace("Object ", "")
    place = ""
    if found := re.search(r" - at `\$?\.?(.*)`$", message):
        place, message = found.group(1).strip("."), message[: found.start()]
    if found := re.search(r"contains unknown field `(.*)`", message):
        name = found.group(1)
        key = f"{place}.{name}" if place else name
        return f"unknown key {key!r}{suggest(name, _keys(record))}"
    return f"{place}: {message}" if place else message


def _keys(record: type) -> set[str]:
    """Return the names of all fields of `record` and of the records inside it."""
    names: set[str] = set()
    seen: set[type] = set()

    def visit(kind: object) -> None:
        info = getattr(kind, "__args__", ())
        for inner in info:
            visit(inner)
        if isinstance(kind, type) and issubclass(kind, msgspec.Struct) and kind not in seen:
            seen.add(kind)
            for item in msgspec.structs.fields(kind):
                names.add(item.encode_name)
                visit(item.type)

    visit(record)
    return names
