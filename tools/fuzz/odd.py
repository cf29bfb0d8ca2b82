"""Values that people and programs write by mistake."""

import random

NUMBERS = (
    "nan",
    "inf",
    "-inf",
    "-1",
    "0",
    "0.0",
    "1e-300",
    "1e308",
    "1e999",
    "99999999999999999999",
)
"""Numbers out of range, or of no range; those that a command would obey for hours are left out."""
WORDS = (
    "",
    " ",
    "op3",
    "l_knee",
    "\u00fc\u0000\u202e",
    "a" * 5000,
    "../..",
    "-",
    "--",
    "%s%n",
    "[1]",
)
"""Words that mean something else, or nothing."""
TOML = ('""', '"op3"', "true", "[]", "{}", "[[1]]", '"x" # x', "1979-05-27", "0x", "'''", "\\")
"""Values of another type, and what is no value."""


def number(dice: random.Random) -> str:
    """Return an odd number as text."""
    return dice.choice(NUMBERS)


def word(dice: random.Random) -> str:
    """Return an odd word."""
    return dice.choice(WORDS)
