"""What is called again and again, so that somebody who watches knows that this program lives."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Protocol

Heartbeat = Callable[[], None]


class Beating(Protocol):
    """What calls its heartbeat while it works."""

    heartbeat: Heartbeat


def no_heartbeat() -> None:
    """Tell nobody."""


@contextmanager
def beating(parts: Sequence[Beating], heartbeat: Heartbeat) -> Iterator[None]:
    """Have `parts` call `heartbeat` meanwhile."""
    before = [part.heartbeat for part in parts]
    for part in parts:
        part.heartbeat = heartbeat
    try:
        yield
    finally:
        for part, old in zip(parts, before, strict=True):
            part.heartbeat = old
