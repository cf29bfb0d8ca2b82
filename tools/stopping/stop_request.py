"""Stop requests other than signals: robot buttons, terminal keys, and `windup stop`."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from windup.hal.backend import Backend
from windup.hal.errors import UsageError
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.hal.stopping.stop_flag import StopFlag
from windup.tools.stopping.stop_keys import keyboard, stop_keys

COMMAND = "`windup stop`"
"""Name of a request by the stop flag."""


def pressed_button(backend: Backend) -> str | None:
    """Return the name of the robot's button that was pressed since arming, or None."""
    if isinstance(backend, ServoBackend) and backend.button.pressed is not None:
        return f"the {backend.button.pressed} button"
    return None


def told_to_stop(flag: StopFlag | None) -> str | None:
    """Return the name of a request by the stop flag, or None; the request then counts as seen."""
    return COMMAND if flag is not None and flag.asked() else None


@contextmanager
def stop_requests(
    backend: Backend, *, keys: bool, flag: StopFlag | None = None
) -> Iterator[Callable[[], str | None]]:
    """Yield a function that returns the name of a stop request, or None; call it once per tick.

    Args:
        backend: The robot, whose buttons, if any, are stop requests.
        keys: Whether keys of the terminal, if any, are stop requests too.
        flag: Stop flag of the run.
    """
    with stop_keys(keyboard() if keys else None) as pressed_key:

        def asked() -> str | None:
            return told_to_stop(flag) or pressed_button(backend) or pressed_key()

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
