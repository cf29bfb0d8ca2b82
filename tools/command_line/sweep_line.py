"""Separates the options of `windup sweep` from those of the command that it runs."""

OWN = ("--grid", "--random", "--seed", "--seeds", "--out", "--jobs")


def separate(arguments: list[str]) -> list[str]:
    """Return the command line with a sweep's own options before its command.

    >>> separate(["sweep", "walk", "op3", "--rv", "up", "--out", "a.csv"])
    ['sweep', '--out', 'a.csv', '--', 'walk', 'op3', '--rv', 'up']
    """
    if arguments[:1] != ["sweep"] or "--" in arguments:
        return arguments
    if {"-h", "--help"} & set(arguments):
        return ["sweep", "--help"]
    own, line = [], []
    rest = iter(arguments[1:])
    for word in rest:
        if word in OWN:
            own += [word, *(value for value in [next(rest, None)] if value is not None)]
        elif word.partition("=")[0] in OWN:
            own.append(word)
        else:
            line.append(word)
    return ["sweep", *own, *(["--", *line] if line else [])]
