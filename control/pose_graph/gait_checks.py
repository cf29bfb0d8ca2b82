"""Checks of references between a gait file's tables; every message is one line."""

from collections.abc import Iterable, Iterator
from itertools import pairwise

from windup.control.pose_graph.gait_file import GaitFile, State
from windup.control.regulation.variables import regulation_variables
from windup.hal.errors import UnknownNameError
from windup.hal.joints import Joints

Mistake = tuple[str, str]
"""Key and message."""


def table_mistakes(file: GaitFile, joints: Joints) -> Iterator[Mistake]:
    """Yield each mistake in the names by which tables refer to each other and to the joints."""
    names = [item.name for item in file.perturbation]
    parts = [(item.name, item.states and sorted(item.states)) for item in file.perturbation]
    for number, (name, states) in enumerate(parts):
        if (name, states) in parts[:number]:
            why = "this name stands twice; give each its own, or other states"
            yield f"perturbation.{name}", why
    yield from _balance(file, names)
    yield from _speed(file, names)
    yield from _steering(file, names)
    yield from _styles(file, names)
    if file.torso_servo is not None:
        yield from _known("torso_servo.joint", [file.torso_servo.joint], joints.names, "joint")
    if file.staged:
        yield from _stages(file, joints)


def _balance(file: GaitFile, names: list[str]) -> Iterator[Mistake]:
    if file.balance is None:
        return
    yield from _known("balance.perturbations", file.balance.perturbations, names)
    try:
        regulation_variables([*file.balance.regulation, *file.balance.targets])
    except UnknownNameError as error:
        yield "balance.regulation", str(error)


def _speed(file: GaitFile, names: list[str]) -> Iterator[Mistake]:
    if file.speed is None:
        return
    speeds = [row.speed for row in file.speed.rows]
    if not speeds:
        yield "speed.rows", "a speed table needs at least one row"
    if any(after <= before for before, after in pairwise(speeds)):
        yield "speed.rows", "the speeds have to rise from row to row"
    for row in file.speed.rows:
        yield from _known("speed.rows.scale", row.scale, names)


def _steering(file: GaitFile, names: list[str]) -> Iterator[Mistake]:
    if file.side is not None:
        yield from _known("side.scale", file.side.scale, names)
        yield from _known("side.spread", file.side.spread, names)
    if file.heading is not None:
        yield from _known("heading.perturbation", [file.heading.perturbation], names)
    if file.turn is not None:
        yield from _known("turn.perturbation", filter(None, [file.turn.perturbation]), names)
        yield from _known("turn.spread", file.turn.spread, names)
    if file.incline is not None:
        yield from _known("incline.perturbation", [file.incline.perturbation], names)


def _styles(file: GaitFile, names: list[str]) -> Iterator[Mistake]:
    if file.slip is not None:
        named = [style.name for style in file.style]
        yield from _known("slip.style", [file.slip.style], [*named, *names], "style")
        yield from _known("slip.states", file.slip.states, [s.name for s in file.state], "state")
    for style in file.style:
        yield from _known(f"style.{style.name}.scale", style.scale, names)


def _stages(file: GaitFile, joints: Joints) -> Iterator[Mistake]:
    """Yield mistakes in `move`, `reach`, `upright`, which only a graph that is played can have."""
    if file.balance is not None or file.mirror:
        yield (
            "state",
            "`move`, `reach` and `upright` are for graphs without balance and mirror",
        )
    names = [state.name for state in file.state]
    if file.upright is not None:
        yield from _known("upright.states", file.upright.states or [], names, "state")
        for key in ("forward", "forward_rate", "right", "right_rate"):
            given = getattr(file.upright, key)
            yield from _known(f"upright.{key}", given, joints.names, "joint")
    for state in file.state:
        yield from _stage(state, names)


def _stage(state: State, names: list[str]) -> Iterator[Mistake]:
    where = f"state.{state.name}"
    if state.until.time is None:
        yield f"{where}.until", "beside `move`, `reach` and `upright`, give a `time`"
    elif not 0.0 <= state.move <= state.until.time:
        why = f"{state.move:g} s do not fit into the state's {state.until.time:g} s"
        yield f"{where}.move", why
    if state.reach is not None and state.reach.again is not None:
        yield from _known(f"{where}.reach.again", [state.reach.again], names, "state")


def _known(
    key: str, wanted: Iterable[str], known: Iterable[str], kind: str = "perturbation"
) -> Iterator[Mistake]:
    for name in wanted:
        if name not in known:
            yield key, str(UnknownNameError(kind, name, known))
