"""What asks a run to stop beside a signal: a button of the robot, or a key of the terminal."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from windup.hal.backend import Backend
from windup.hal.errors import UsageError
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.tools.stopping.stop_keys import keyboard, stop_keys


def pressed_button(backend: Backend) -> str | None:
    """Return which button of the robot has been pressed since it was armed, for people."""
    if isinstance(backend, ServoBackend) and backend.button.pressed is not None:
        return f"the {backend.button.pressed} button"
    return None


@contextmanager
def stop_requests(backend: Backend, *, keys: bool) -> Iterator[Callable[[], str | None]]:
    """Yield a function that returns who wants the robot to stop, or None; ask it once a tick.

    Args:
        backend: Its buttons, where it has any, are a stop.
        keys: So are keys of the terminal, where there is one.
    """
    with stop_keys(keyboard() if keys else None) as pressed_key:

        def asked() -> str | None:
            return pressed_button(backend) or pressed_key()

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
