"""Options of the command line from the constructor of a user's controller."""

from collections.abc import Iterable, Mapping
from copy import copy
from dataclasses import dataclass, field, make_dataclass
from enum import Enum
from functools import partial
from inspect import Parameter, getdoc, signature
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Final, Literal, Union, get_args, get_origin, get_type_hints

from windup.hal.errors import UsageError
from windup.tools.terminal.quantities import Duration

GIVEN: Final = ("robot", "joints", "stance", "predictor")
"""Parameters of a constructor that get the robot's own: `RobotDescription`, `Joints`, its stance
(n,) rad, and a `Predictor`."""
PLAIN: Final = (bool, int, float, str, Path)
"""Types that an option may have, also in tuples, lists, unions and literals."""


@dataclass(frozen=True, kw_only=True)
class RunTime:
    """Option of every controller of a user's own."""

    seconds: Duration = 5.0
    """How long it runs, s; on a port, from the end of the first motion on."""


def constructor_options(kind: type, place: str) -> tuple[type, tuple[str, ...], tuple[str, ...]]:
    """Return a dataclass of options, the names that are options, and those that are `GIVEN`.

    A parameter without an annotation has the type of its default. One that no command line can
    give is left at its default.

    Args:
        kind: Class of the controller.
        place: Where it is defined, for messages.

    Raises:
        UsageError: A parameter without a default can be neither an option nor given.
    """
    parameters = _parameters(kind)
    hints = _hints(kind, place)
    options: list[tuple[str, Any, Any]] = []
    for name in parameters:
        if name not in GIVEN:
            options += _option(kind, parameters[name], hints, place)
    record = make_dataclass(
        f"{kind.__name__}Options",
        options,
        bases=(RunTime,),
        frozen=True,
        kw_only=True,
        namespace={"__doc__": _documented(kind), "__module__": __name__},
    )
    given = tuple(name for name in parameters if name in GIVEN)
    return record, tuple(name for name, _, _ in options), given


def _parameters(kind: type) -> Mapping[str, Parameter]:
    found = signature(kind).parameters
    several = (Parameter.VAR_POSITIONAL, Parameter.VAR_KEYWORD)
    return {name: item for name, item in found.items() if item.kind not in several}


def _hints(kind: Any, place: str) -> dict[str, Any]:
    """Return the annotations of a constructor.

    Raises:
        UsageError: One is a name that the file does not have.
    """
    try:
        return get_type_hints(kind.__init__, include_extras=True)
    except NameError as error:
        raise UsageError(f"{place}: {error}") from None


def _option(
    kind: type, parameter: Parameter, hints: Mapping[str, Any], place: str
) -> Iterable[tuple[str, Any, Any]]:
    """Return a parameter as a field of a dataclass; nothing if it stays at its default."""
    name, default = parameter.name, parameter.default
    required = default is Parameter.empty
    hint = hints.get(name, str if required else type(default))
    if required and (name not in hints or not _is_plain(hint)):
        raise UsageError(
            f"{place}: {kind.__name__} takes {name!r}, which cannot be an option: annotate it as "
            f"float, int, bool or str, or call it one of {', '.join(GIVEN)}"
        )
    if not _is_plain(hint):
        return ()
    if required:
        return ((name, hint, field()),)
    if isinstance(default, list):
        return ((name, hint, field(default_factory=partial(copy, default))),)
    return ((name, hint, field(default=default)),)


def _is_plain(hint: Any) -> bool:
    """Return whether words of a command line can be converted to this type."""
    if get_origin(hint) is Literal:
        return True
    if get_origin(hint) is Annotated:
        return _is_plain(get_args(hint)[0])
    if get_origin(hint) in (tuple, list, Union, UnionType):
        return all(_is_plain(part) for part in get_args(hint) if part not in (NoneType, ...))
    return hint in PLAIN or (isinstance(hint, type) and issubclass(hint, Enum))


def _documented(kind: Any) -> str:
    """Return the documentation of a class and its constructor, whose `Args` are the help."""
    own = getdoc(kind) or f"Run {kind.__name__}."
    inside = kind.__init__.__doc__ if "__init__" in vars(kind) else None
    return f"{own}\n\n{inside}" if inside else own
