"""Styles and blends as a user writes them: NAME, NAME=AMOUNT, NAME=AMOUNT@BEGIN:END."""

from dataclasses import replace
from pathlib import Path

from windup.control.pose_graph.blend import blend_name, with_blend
from windup.control.pose_graph.gait import Gait
from windup.control.pose_graph.style import StyleInterval
from windup.hal.errors import UsageError
from windup.hal.ranges import Range, read_number
from windup.robots import RobotDescription
from windup.tools.assembly.gaits import find_gait
from windup.tools.assembly.walk_options import WalkOptions

AMOUNT = Range(-1_000.0, 1_000.0)


def styles_of_walk(options: WalkOptions) -> tuple[StyleInterval, ...]:
    """Return the styles of a walk, and its blends.

    Raises:
        UsageError: One cannot be decode.
    """
    styles = [spell(text, "--style") for text in options.style]
    return (*styles, *(_blend(text) for text in options.blend))


def _blend(text: str) -> StyleInterval:
    """Return the spell of the style that blends a gait in."""
    found = spell(text, "--blend")
    return replace(found, name=blend_name(Path(found.name).stem))


def blended(robot: RobotDescription, gait: Gait, options: WalkOptions) -> Gait:
    """Return `gait` with the gaits to blend into it.

    Raises:
        UsageError: A blend cannot be decode.
        UnknownNameError: There is no such gait.
        ConfigError: The graphs have different states.
    """
    for name in dict.fromkeys(spell(text, "--blend").name for text in options.blend):
        gait = with_blend(gait, find_gait(robot, name))
    return gait


def spell(text: str, option: str) -> StyleInterval:
    """Return what "NAME=AMOUNT@BEGIN:END" says: amounts are 1, and times all, if left away.

    >>> spell("duck=1@5:12", "--style")
    StyleInterval(name='duck', amount=1.0, begin=5.0, end=12.0)

    Raises:
        UsageError: It says nothing that can be.
    """
    what, at, times = text.partition("@")
    name, equals, value = what.partition("=")
    begin, colon, end = times.partition(":")
    where = f"{option} {text}"
    found = StyleInterval(
        name,
        read_number(where, value, AMOUNT) if equals else 1.0,
        read_number(where, begin) if at else 0.0,
        read_number(where, end) if colon else float("inf"),
    )
    if not 0.0 <= found.begin < found.end:
        raise UsageError(f"{option} {text}: begin at 0 s or later, and end after that")
    return found
