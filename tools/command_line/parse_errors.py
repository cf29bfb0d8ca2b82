"""One-line messages for wrong command lines: the wrong word, a similar one, and what to run."""

import re
from dataclasses import fields
from itertools import takewhile
from typing import Any, get_args, get_type_hints

import tyro

from windup.hal.ranges import SHOWN
from windup.tools.command_line.near_word import near_word

WORDS = {"FLOAT FLOAT": "two numbers", "FLOAT": "a number", "INT": "a whole number", "|": " or "}


def mistake(name: str, command: type, words: list[str], said: str) -> str:
    """Return a message for a command line that the parser rejected.

    Args:
        name: Name of the command.
        command: Class of the command.
        words: Words after the name.
        said: Output of the parser, in its box.
    """
    known, usage = options(command), getattr(command, "usage", "") or name
    for word in takewhile(lambda word: word != "--", words):
        option = word.partition("=")[0].replace("_", "-")
        if word.startswith("--") and option not in known:
            near = near_word(option, known)
            return f"{name}: unknown option {option}{near}; `windup {usage} --help` lists all"
    if missing := re.match(r"Missing from windup \S+: (.*?)\.? \(required\)", gist(said)):
        return f"{name}: {_wanted(missing[1])}; see `windup {usage} --help`"
    return wrong_number(said) or f"{name}: {gist(said).rstrip('.')}; see `windup {usage} --help`"


def options(command: Any) -> set[str]:
    """Return the options of a command, as written on a command line."""
    hints = get_type_hints(command, include_extras=True)
    names = [
        field.name.replace("_", "-")
        for field in fields(command)
        if tyro.conf.Positional not in get_args(hints[field.name])
    ]
    return {"--help", *(f"--{name}" for name in names), *(f"--no-{name}" for name in names)}


def _wanted(missing: str) -> str:
    """Return what to give, from the parser's line about a missing argument.

    Of a long explanation it has the first sentence.

    >>> _wanted("URL The port: /dev/ttyUSB0, usb:SERIAL")
    'give URL (the port: /dev/ttyUSB0, usb:SERIAL)'
    >>> _wanted("{robot,gait, controller} What to write. Nothing is overwritten")
    'give one of robot, gait, controller (what to write)'
    """
    found = re.match(r"((?:--[\w-]+ )?(?:[A-Z]+|\{[^}]*\})) (.*)", missing)
    if found is None:
        return f"give {missing}"
    name, about = found[1], re.split(r"\.\s", found[2])[0]
    if "{" in name:
        option, _, choices = name.rstrip("}").partition("{")
        name = f"{option}one of " + re.sub(r",\s*", ", ", choices)
    return f"give {name} ({about[:1].lower()}{about[1:]})"


def gist(said: str) -> str:
    """Return the text inside the parser's box, on one line."""
    lines = [line.strip(" │") for line in said.splitlines()]
    rules = [i for i, line in enumerate(lines) if set(line) and set(line) <= set("-─╭╮╰╯")]
    first = rules[0] + 1 if rules else 0
    last = rules[1] if len(rules) > 1 else len(lines)
    return " ".join(line for line in lines[first:last] if line)


def wrong_number(said: str) -> str:
    """Return a message for an option whose value is not a number; "" for any other problem.

    >>> wrong_number("Error parsing --seed: invalid literal for int() with base 10: '1.5'")
    '--seed 1.5: give a whole number'
    """
    found = re.match(r"Error parsing (--[\w-]+): (.*)", gist(said))
    if found is None:
        return ""
    option, why = found.groups()
    wanted = re.match(r"no type matching (?:\{None\}\|)?(.*?) could be instantiated", why)
    kind = (
        wanted[1] if wanted else "INT" if "int()" in why else "FLOAT" if "to float" in why else ""
    )
    if "INT" not in kind and "FLOAT" not in kind:
        return ""
    given = re.findall(r"'([^']*)'", why.partition(" from ")[2].partition("]")[0] or why)
    for word, plain in WORDS.items():
        kind = kind.replace(word, plain)
    return f"{option} {' '.join(given)[:SHOWN]}: give {re.sub('[{}]', '', kind)}"
