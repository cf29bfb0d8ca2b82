"""The tables of the page on telemetry as Markdown, made from the layout itself."""

from collections.abc import Iterable, Sequence

from windup.hal.publishing.run_state import RunState
from windup.hal.telemetry.fields import KINDS
from windup.hal.telemetry.layout import HEAD, MEANINGS, at
from windup.tools.schemas.docstrings import key_texts


def states_table() -> str:
    """Return code, name and meaning of each state of a run."""
    texts = key_texts(RunState)
    rows = ((str(int(state)), state.words, texts[state.name]) for state in RunState)
    return _table(("code", "state", "meaning"), rows)


def fields_table() -> str:
    """Return name, type, shape, unit and meaning of each field of a tick."""
    rows = (
        (f"`{kind.name}`", kind.type[1:], ", ".join(kind.shape), kind.unit, kind.meaning)
        for kind in KINDS
    )
    return _table(("field", "type", "shape", "unit", "meaning"), rows)


def head_table() -> str:
    """Return name, offset, type and meaning of each field of the head of the file."""
    rows = (
        (f"`{name}`", str(at(name)), HEAD[name].str.lstrip("<|"), MEANINGS[name])
        for name in HEAD.names or ()
    )
    return _table(("field", "offset", "type", "meaning"), rows)


def _table(titles: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [titles, ["---"] * len(titles), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
