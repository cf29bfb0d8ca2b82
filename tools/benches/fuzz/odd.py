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
ROBOTS = ("op3", "duck", "human", "opp3", "", "/", "..", "-", "x" * 300, "/dev/null", "\u00fc")
"""Robots, and names that are none."""
URLS = (
    "twin://op3",
    "twin://op3?latency=nan",
    "twin://bench?servos=XM430-W350:1-1000000000",
    "twin:///etc",
    "twin://[",
    "twin://",
    "twin://op3?=&&?",
    "://",
    "socket://[::1",
    "socket://a:b",
    "usb:",
    "body=twin://op3,,=",
    "/dev/zero",
    "",
)
"""Ports, and what is none."""
LARGE = ("9" * 5000, "1000000000", "3", "0.5")
"""More numbers; some would be obeyed for hours."""
MEANT = (
    *("=", "a=1", "a=nan@1:2", "speed=0:1:1000000000", "speed=0:1:3", ",", "circle:nan", "0,0,1"),
    *("/dev/zero", "/dev/full", "/dev/null", ".", "none/x.json", "x" * 300, "a.csv", "a.toml"),
    *("a.png", "stand", "left", "hold", "front", "walk", "*"),
)
"""What some options take, in their place or out of it."""
VALUES = (*NUMBERS, *LARGE, *WORDS, *MEANT, "true")
"""Whatever stands behind an option."""
TOML = ('""', '"op3"', "true", "[]", "{}", "[[1]]", '"x" # x', "1979-05-27", "0x", "'''", "\\")
"""Values of another type, and what is no value."""


def number(dice: random.Random) -> str:
    """Return an odd number as text."""
    return dice.choice(NUMBERS)


def word(dice: random.Random) -> str:
    """Return an odd word."""
    return dice.choice(WORDS)
