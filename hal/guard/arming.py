"""Before and after torque comes on: is everybody well, and has everybody answered lately?"""

from windup.hal.backend import Backend, HealthReader
from windup.hal.guard.watch import HealthWatch

ATTEMPTS = 10


def check_health(backend: Backend, watch: HealthWatch | None, max_age: float) -> None:
    """Look twice at every joint before torque comes on.

    Args:
        backend: Where they are.
        watch: Who judges them.
        max_age: Age of an answer from which on it says nothing, s.

    Raises:
        UnhealthyError: A joint is beyond a stop level.
    """
    if watch is None or not isinstance(backend, HealthReader):
        return
    seen = []
    for _ in range(2):
        backend.read_health()
        seen.append(backend.read())
    if (unwell := watch.refuse(seen, max_age)) is not None:
        raise unwell


def read_afresh(backend: Backend, max_age: float) -> None:
    """Read until everybody has answered lately: arming took its time, and answers get lost."""
    for _ in range(ATTEMPTS):
        if backend.read().joints.age.max() < 0.5 * max_age:
            return
