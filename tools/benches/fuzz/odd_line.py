"""Odd command lines: every command, a few options, odd values, unwritable result files."""

import random
from collections.abc import Mapping, Sequence
from pathlib import Path

from windup.tools.benches.fuzz import odd

SHORT = {
    "stand": ("--seconds", "0.1"),
    "play": ("squat", "--seconds", "0.1"),
    "walk": ("--steps", "1"),
    "push": ("--impulse", "0.2"),
    "rise": ("--tries", "1"),
    "stride": ("--seconds", "0.1"),
    "step": ("--to", "0.05", "0.08"),
    "footprints": ("--random", "1"),
    "health": ("--once",),
}
"""Commands on a robot, with options that make them short."""
NUMBERS = tuple(
    f"--{name}"
    for name in [
        "rate",
        "seed",
        "noise",
        "slope",
        "strips",
        "stairs",
        "rough",
        "friction",
        "plant",
        "gains",
        "push",
        "shove",
        "push-direction",
        "push-at",
    ]
)
"""Options with a number that every command but `health` has."""
OWN = {
    "walk": "--speed --side --turn --delay --stand",
    "push": "--duration --direction --height --at --times --every --delay --speed",
    "stride": "--speed --heading --face",
    "step": "--yaw --duration",
    "rise": "--tries",
}
"""Options with a number that a single command has."""
WORDS = {
    "walk": "--gait --path --style --model --learn --target --rv",
    "push": "--body --way --stance --support --forbid --during",
    "stride": "--then",
    "step": "--foot --frame",
    "rise": "--lying",
}
"""Options with a word as their value."""
SWITCHES = ["--self-collision", "--no-protect", "--realtime", "--arm", "--hlep"]
OPTIONS = 2
"""Largest number of options on one line."""
MILD = ("0.05", "0.1", "1", "3", "45", "-0.1")
"""Plausible numbers for options."""


def odd_line(rng: random.Random, robot: str, folder: Path) -> list[str]:
    """Return the words of a command line on `robot`, with result files in `folder`."""
    command = rng.choice(list(SHORT))
    words = [command, robot, *SHORT[command]]
    for _ in range(rng.randint(0, OPTIONS)):
        words += _option(rng, command)
    if rng.random() < 0.3:
        words += ["--port", _port(rng, robot)]
    if rng.random() < 0.3:
        words += [rng.choice(("--json", "--plot")), _target(rng, folder)]
    if rng.random() < 0.1:
        words.insert(rng.randrange(len(words)), odd.word(rng))
    return _passed_on(words)


def any_line(rng: random.Random, options: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the words of any command, which may run for hours, with any of its `options`.

    Args:
        rng: Random number generator.
        options: Options of every command by its name, such as "--speed".
    """
    command = rng.choice(sorted(options))
    words = [command, *rng.choices(odd.ROBOTS, k=rng.randint(0, 2))]
    for _ in range(rng.randint(0, 3)):
        option = rng.choice(options[command])
        values = odd.URLS if option in ("--port", "--url") else odd.VALUES
        words += [option, *rng.choices(values, k=rng.randint(0, 2))]
    return _passed_on(words)


def _passed_on(words: list[str]) -> list[str]:
    """Return the words without characters that a shell cannot pass on."""
    return [word.replace("\0", "") for word in words]


def _option(rng: random.Random, command: str) -> list[str]:
    """Return an option of a command, with a value that may be odd."""
    kind = rng.random()
    words = WORDS.get(command, "--state").split()
    if kind < 0.65:
        value = odd.number(rng) if rng.random() < 0.5 else rng.choice(MILD)
        return [rng.choice((*NUMBERS, *OWN.get(command, "").split())), value]
    if kind < 0.9:
        return [rng.choice((*words, "--faults", "--state")), odd.word(rng)]
    return [rng.choice(SWITCHES)]


def _port(rng: random.Random, robot: str) -> str:
    """Return a port URL: odd, or emulated with an odd setting."""
    if rng.random() < 0.2:
        return rng.choice(odd.URLS)
    return f"twin://{rng.choice((robot, 'op3', 'bench'))}?{_query(rng)}"


def _query(rng: random.Random) -> str:
    """Return the query of a twin:// URL."""
    keys = ("clock", "latency", "servos", "faults", "supply", "seed", "missing", "return_delay")
    values = (odd.number(rng), odd.word(rng), "virtual", "XM430-W350:1-1000000000")
    return f"clock=virtual&{rng.choice(keys)}={rng.choice(values)}"


def _target(rng: random.Random, folder: Path) -> str:
    """Return the path of a result file, writable or not."""
    names = ("/dev/full", str(folder), "/nowhere/x.json", str(folder / "x.json"), "-", "/dev/zero")
    return rng.choice((*names, odd.word(rng)[:300] or "x"))
