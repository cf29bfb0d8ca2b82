"""Inserts random mistakes into a valid TOML file."""

import random
import re
from collections.abc import Callable

from windup.tools.benches.fuzz import odd

VALUE = re.compile(r"(?P<key>[A-Za-z_][\w.]*)\s*=\s*(?P<value>\"[^\"\n]*\"|[^,{}\[\]#\n]+)")
"""A key and its value, on a line of its own or in an inline table."""

Mistake = Callable[[random.Random, str], str]


def broken_toml(rng: random.Random, text: str) -> str:
    """Return `text` with one to three mistakes."""
    for _ in range(rng.randint(1, 3)):
        text = rng.choice(MISTAKES)(rng, text)
    return text


def other_value(rng: random.Random, text: str) -> str:
    """Give a key an odd value."""
    found = list(VALUE.finditer(text))
    if not found:
        return text
    where = rng.choice(found)
    value = rng.choice((odd.number(rng), f'"{odd.word(rng)}"', rng.choice(odd.TOML)))
    return text[: where.start("value")] + value + text[where.end("value") :]


def other_key(rng: random.Random, text: str) -> str:
    """Misspell a key."""
    found = list(VALUE.finditer(text))
    if not found:
        return text
    where = rng.choice(found)
    key = where["key"]
    return (
        text[: where.start("key")]
        + rng.choice((key[:-1], key + "_", key.upper()))
        + text[where.end("key") :]
    )


def without_line(rng: random.Random, text: str) -> str:
    """Remove a line."""
    lines = text.splitlines(keepends=True)
    if lines:
        del lines[rng.randrange(len(lines))]
    return "".join(lines)


def line_twice(rng: random.Random, text: str) -> str:
    """Duplicate a line."""
    lines = text.splitlines(keepends=True)
    if lines:
        at = rng.randrange(len(lines))
        lines.insert(at, lines[at])
    return "".join(lines)


def lines_swapped(rng: random.Random, text: str) -> str:
    """Move a line elsewhere."""
    lines = text.splitlines(keepends=True)
    if lines:
        lines.insert(rng.randrange(len(lines)), lines.pop(rng.randrange(len(lines))))
    return "".join(lines)


def cut_off(rng: random.Random, text: str) -> str:
    """Truncate the file."""
    return text[: rng.randrange(len(text) + 1)]


def with_mark(rng: random.Random, text: str) -> str:
    """Begin with a byte-order mark, as some editors do."""
    return "\ufeff" + text


MISTAKES: tuple[Mistake, ...] = (
    *(other_value,) * 6,
    *(other_key,) * 2,
    *(without_line,) * 2,
    line_twice,
    lines_swapped,
    cut_off,
    with_mark,
)
