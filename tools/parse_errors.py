"""What the command line's parser says in a box, as one line."""

import re

from hal.ranges import SHOWN

WORDS = {"FLOAT FLOAT": "two numbers", "FLOAT": "a number", "INT": "a whole number", "|": " or "}


def gist(said: str) -> str:
    """Return what the box says, on one line."""
    lines = [line.strip(" │") for line in said.splitlines()]
    rules = [i for i, line in enumerate(lines) if set(line) and set(line) <= set("-─╭╮╰╯")]
    first = rules[0] + 1 if rules else 0
    last = rules[1] if len(rules) > 1 else len(lines)
    return " ".join(line for line in lines[first:last] if line)


def wrong_number(said: str) -> str:
    """Return which option has no number where one should be; "" where the box is about more.

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
