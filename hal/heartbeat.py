"""Heartbeat: a callback called regularly, so that a watchdog can tell that this program runs."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Protocol

Heartbeat = Callable[[], None]


class HasHeartbeat(Protocol):
    """An object that calls its `heartbeat` during long operations."""

    heartbeat: Heartbeat


def no_heartbeat() -> None:
    """Do nothing: the heartbeat of a program without a watchdog."""


@contextmanager
def with_heartbeat(parts: Sequence[HasHeartbeat], heartbeat: Heartbeat) -> Iterator[None]:
    """Make `parts` call `heartbeat` inside the `with` block; restore their own afterwards."""
    before = [part.heartbeat for part in parts]
    for part in parts:
        part.heartbeat = heartbeat
    try:
        yield
    finally:
        for part, old in zip(parts, before, strict=True):
            part.heartbeat = old
