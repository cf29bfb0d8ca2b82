"""Values that people and programs enter by mistake."""

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
"""Numbers out of range or not finite, except those with which a command would run for hours."""
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
"""Words that are invalid or mean something else."""
ROBOTS = ("op3", "duck", "human", "opp3", "", "/", "..", "-", "x" * 300, "/dev/null", "\u00fc")
"""Names of robots, valid and invalid."""
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
"""Port URLs, valid and invalid."""
LARGE = ("9" * 5000, "1000000000", "3", "0.5")
"""More numbers, with some of which a command would run for hours."""
MEANT = (
    *("=", "a=1", "a=nan@1:2", "speed=0:1:1000000000", "speed=0:1:3", ",", "circle:nan", "0,0,1"),
    *("/dev/zero", "/dev/full", "/dev/null", ".", "none/x.json", "x" * 300, "a.csv", "a.toml"),
    *("a.png", "stand", "left", "hold", "front", "walk", "*"),
)
"""Values that some option accepts, used with any option."""
VALUES = (*NUMBERS, *LARGE, *WORDS, *MEANT, "true")
"""All values that may follow an option."""
TOML = ('""', '"op3"', "true", "[]", "{}", "[[1]]", '"x" # x', "1979-05-27", "0x", "'''", "\\")
"""TOML values of other types, and invalid ones."""


def number(rng: random.Random) -> str:
    """Return an odd number as text."""
    return rng.choice(NUMBERS)


def word(rng: random.Random) -> str:
    """Return an odd word."""
    return rng.choice(WORDS)
