"""Inserts random mistakes into a valid TOML file."""

import random
import re
from collections.abc import Callable

from windup.tools.benches.fuzz import odd

VALUE = re.compile(r"(?P<key>[A-Za-z_][\w.]*)\s*=\s*(?P<value>\"[^\"\n]*\"|[^,{}\[\]#\n]+)")
"""A key and its value, on a line of its own or in an inline table."""

Mistake = Callable[[random.Random, str], str]


def broken_toml(dice: random.Random, text: str) -> str:
    """Return `text` with one to three mistakes."""
    for _ in range(dice.randint(1, 3)):
        text = dice.choice(MISTAKES)(dice, text)
    return text


def other_value(dice: random.Random, text: str) -> str:
    """Give a key an odd value."""
    found = list(VALUE.finditer(text))
    if not found:
        return text
    where = dice.choice(found)
    value = dice.choice((odd.number(dice), f'"{odd.word(dice)}"', dice.choice(odd.TOML)))
    return text[: where.start("value")] + value + text[where.end("value") :]


def other_key(dice: random.Random, text: str) -> str:
    """Misspell a key."""
    found = list(VALUE.finditer(text))
    if not found:
        return text
    where = dice.choice(found)
    key = where["key"]
    return (
        text[: where.start("key")]
        + dice.choice((key[:-1], key + "_", key.upper()))
        + text[where.end("key") :]
    )


def without_line(dice: random.Random, text: str) -> str:
    """Remove a line."""
    lines = text.splitlines(keepends=True)
    if lines:
        del lines[dice.randrange(len(lines))]
    return "".join(lines)


def line_twice(dice: random.Random, text: str) -> str:
    """Duplicate a line."""
    lines = text.splitlines(keepends=True)
    if lines:
        at = dice.randrange(len(lines))
        lines.insert(at, lines[at])
    return "".join(lines)


def lines_swapped(dice: random.Random, text: str) -> str:
    """Move a line elsewhere."""
    lines = text.splitlines(keepends=True)
    if lines:
        lines.insert(dice.randrange(len(lines)), lines.pop(dice.randrange(len(lines))))
    return "".join(lines)


def cut_off(dice: random.Random, text: str) -> str:
    """Truncate the file."""
    return text[: dice.randrange(len(text) + 1)]


def with_mark(dice: random.Random, text: str) -> str:
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
