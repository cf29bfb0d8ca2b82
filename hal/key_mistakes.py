"""All mistakes in the keys of a TOML file: unknown keys, missing keys, invalid values."""

from collections.abc import Iterator
from copy import deepcopy
from types import UnionType
from typing import Any, Literal, NamedTuple, Union, get_args, get_origin

import msgspec

from windup.hal.errors import suggest

Path = tuple[str | int, ...]
"""Keys of tables and indices of arrays that lead to a value."""
CONTAINERS = {dict: dict, list: list, tuple: list}
"""Type of a field, and the type that the TOML parser returns for it."""


class KeyMistake(NamedTuple):
    """One mistake.

    Attributes:
        path: Path of the key.
        message: The mistake, and the expected value.
        kind: "unknown": the record has no such key; "missing": it requires the key; "value": the
            value is invalid.
    """

    path: Path
    message: str
    kind: Literal["unknown", "missing", "value"] = "value"

    @property
    def key(self) -> str:
        """The path in the notation of messages.

        >>> KeyMistake(("joint", 3, "lower"), "is missing").key
        'joint[3].lower'
        """
        words = (f"[{part}]" if isinstance(part, int) else f".{part}" for part in self.path)
        return "".join(words).removeprefix(".")


def key_mistakes(data: Any, kind: Any, path: Path = ()) -> Iterator[KeyMistake]:
    """Yield each mistake in `data` as a value of a type.

    Args:
        data: The parsed TOML: dicts, lists and values.
        kind: The type: a record, a container, a union, or the type of one value.
        path: Path of `data` in the file.
    """
    fitting = _fitting(kind, data)
    origin, inner = get_origin(fitting), get_args(fitting)
    if _is_record(fitting) and isinstance(data, dict):
        yield from _of_record(data, fitting, path)
    elif origin in (list, tuple) and isinstance(data, list) and _any_length(fitting):
        for index, item in enumerate(data):
            yield from key_mistakes(item, inner[0], (*path, index))
    elif origin is dict and isinstance(data, dict):
        for name, item in data.items():
            yield from key_mistakes(item, inner[1], (*path, name))
    else:
        try:
            msgspec.convert(data, kind)
        except msgspec.ValidationError as error:
            yield KeyMistake(path, str(error).partition(" - at `")[0])


def without_unknown(data: Any, mistakes: list[KeyMistake]) -> Any:
    """Return a copy of `data` without its unknown keys."""
    data = deepcopy(data)
    for mistake in mistakes:
        if mistake.kind == "unknown":
            table = data
            for part in mistake.path[:-1]:
                table = table[part]
            del table[mistake.path[-1]]
    return data


def _of_record(
    data: dict[str, Any], kind: type[msgspec.Struct], path: Path
) -> Iterator[KeyMistake]:
    fields = {item.encode_name: item for item in msgspec.structs.fields(kind)}
    for name in (name for name in data if name not in fields):
        yield KeyMistake((*path, name), f"unknown key{suggest(name, fields)}", "unknown")
    for name, item in fields.items():
        if name in data:
            yield from key_mistakes(data[name], item.type, (*path, name))
        elif item.required:
            yield KeyMistake((*path, name), "is missing", "missing")


def _fitting(kind: Any, data: Any) -> Any:
    """Return the member of a union that fits the container type of `data`, else `kind` itself."""
    for member in get_args(kind) if _is_union(kind) else ():
        origin = dict if _is_record(member) else CONTAINERS.get(get_origin(member) or member)
        if origin is not None and isinstance(data, origin):
            return member
    return kind


def _is_union(kind: Any) -> bool:
    return get_origin(kind) in (UnionType, Union)


def _is_record(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, msgspec.Struct)


def _any_length(kind: Any) -> bool:
    """Return whether a list or tuple may have any number of items."""
    return get_origin(kind) is list or get_args(kind)[1:] == (Ellipsis,)
