"""Strict TOML into typed records: one error, with the file, the key and the likely word."""

import re
import tomllib
from pathlib import Path
from typing import TypeVar

import msgspec

from hal.errors import ConfigError, suggest

T = TypeVar("T")


class Record(msgspec.Struct, forbid_unknown_fields=True, frozen=True, kw_only=True):
    """Base of every record that stands in a TOML file. An unknown key is an error."""


def load_toml(path: Path, record: type[T]) -> T:
    """Return the file at `path` as a `record`.

    Raises:
        ConfigError: The file is missing, is not TOML, or does not fit the record.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise ConfigError(f"{path}: not TOML: this is no UTF-8 text") from None
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"{path}: not TOML: {error}") from None
    try:
        return msgspec.convert(data, record)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{path}: {_explain(str(error), record)}") from None


def _explain(message: str, record: type) -> str:
    """Turn msgspec's message into ours: the key first, then the likely word."""
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
