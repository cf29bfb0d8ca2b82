"""What asks a run to stop beside a signal: a button of the robot, or a key of the terminal."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from hal.backend import Backend
from hal.errors import UsageError
from hal.servo_backend import ServoBackend
from tools.stop_keys import keyboard, stop_keys

INTERRUPTED = "interrupted"
BUTTON, KEY = "stop button", "stop key"


def asked_for(reason: str) -> bool:
    """Did a run end because somebody asked for it: by Ctrl-C, a button or a key?

    >>> asked_for("stop key (space)"), asked_for("fell")
    (True, False)
    """
    return reason.startswith((INTERRUPTED, BUTTON, KEY))


def reason_of(stop: KeyboardInterrupt) -> str:
    """Return the reason of a run that has been stopped: Ctrl-C itself says none."""
    return str(stop) or INTERRUPTED


@contextmanager
def stop_requests(backend: Backend, *, keys: bool) -> Iterator[Callable[[], str | None]]:
    """Yield a function that returns why a run should stop, or None; ask it once a tick.

    Args:
        backend: Its buttons, where it has any, are a stop.
        keys: So are keys of the terminal, where there is one.
    """
    button = backend.button if isinstance(backend, ServoBackend) else None
    with stop_keys(keyboard() if keys else None) as key:

        def asked() -> str | None:
            if button is not None and button.pressed is not None:
                return f"{BUTTON} ({button.pressed})"
            pressed = key()
            return None if pressed is None else f"{KEY} ({pressed})"

        yield asked


def check_released(backend: Backend) -> None:
    """Raise if a button that stops the robot is down before it has torque.

    Raises:
        UsageError: One is; nothing has moved.
    """
    if isinstance(backend, ServoBackend) and backend.board is not None:
        backend.read()
        if held := backend.button.held:
            raise UsageError(
                f"the {held[0]} button of the robot is held down, and it is a stop: release it"
            )


def how_to_stop(backend: Backend) -> str:
    """Return what stops an armed robot, for people."""
    ways = ["space", "q"] if keyboard() is not None else []
    if isinstance(backend, ServoBackend) and backend.board is not None:
        ways.append("a button on its back")
    return f"{', '.join(ways)} or Ctrl-C stops it" if ways else "Ctrl-C stops it"
