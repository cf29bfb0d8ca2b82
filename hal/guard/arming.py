"""Checks around torque enable: health of all joints before it, fresh observations after it."""

from windup.hal.backend import Backend, HealthReader
from windup.hal.guard.watch import HealthWatch

ATTEMPTS = 10


def check_health(backend: Backend, watch: HealthWatch | None, max_age: float) -> None:
    """Read every joint twice and judge its health before torque enable.

    Args:
        backend: The backend of the joints.
        watch: Judges their health; None skips the check.
        max_age: Maximum age of an answer that is judged, s.

    Raises:
        UnhealthyError: A joint is beyond a stop level.
    """
    if watch is None or not isinstance(backend, HealthReader):
        return
    seen = []
    for _ in range(2):
        backend.read_health()
        seen.append(backend.read())
    if (unwell := watch.error_before_arming(seen, max_age)) is not None:
        raise unwell


def read_fresh(backend: Backend, max_age: float) -> None:
    """Read until all joints have a recent state: arming takes time, and answers may be lost."""
    for _ in range(ATTEMPTS):
        if backend.read().joints.age.max() < 0.5 * max_age:
            return
