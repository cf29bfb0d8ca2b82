"""Stop requests other than signals: buttons of the robot, and keys of the terminal."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from windup.hal.backend import Backend
from windup.hal.errors import UsageError
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.tools.stopping.stop_keys import keyboard, stop_keys


def pressed_button(backend: Backend) -> str | None:
    """Return the name of the robot's button that was pressed since arming, or None."""
    if isinstance(backend, ServoBackend) and backend.button.pressed is not None:
        return f"the {backend.button.pressed} button"
    return None


@contextmanager
def stop_requests(backend: Backend, *, keys: bool) -> Iterator[Callable[[], str | None]]:
    """Yield a function that returns the name of a stop request, or None; call it once per tick.

    Args:
        backend: The robot, whose buttons, if any, are stop requests.
        keys: Whether keys of the terminal, if any, are stop requests too.
    """
    with stop_keys(keyboard() if keys else None) as pressed_key:

        def asked() -> str | None:
            return pressed_button(backend) or pressed_key()

        yield asked


def check_released(backend: Backend) -> None:
    """Check that no button that stops the robot is held down, before torque is switched on.

    Raises:
        UsageError: One is held; nothing has moved.
    """
    if isinstance(backend, ServoBackend) and backend.board is not None:
        backend.read()
        if held := backend.button.held:
            raise UsageError(
                f"the {held[0]} button of the robot is held down, which stops the robot: release it"
            )


def how_to_stop(backend: Backend) -> str:
    """Return a text about what stops an armed robot."""
    ways = ["space", "q"] if keyboard() is not None else []
    if isinstance(backend, ServoBackend) and backend.board is not None:
        ways.append("a button on its back")
    return f"{', '.join(ways)} or Ctrl-C stops it" if ways else "Ctrl-C stops it"
