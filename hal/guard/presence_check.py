"""Checks that every joint of a robot answers and still has its torque."""

import numpy as np

from windup.hal.backend import Backend, TorqueWatched
from windup.hal.errors import PortError, StaleStateError
from windup.hal.joints import Array
from windup.hal.torque_loss import SILENT, torque_lost

MAX_REREADS = 5
"""Maximum number of re-reads of a silent joint before a stop treats its torque as lost."""


class PresenceCheck:
    """Checks every observation for joints that no longer answer or have lost their torque.

    Args:
        backend: The robot.
    """

    def __init__(self, backend: Backend) -> None:
        self._backend = backend
        self._watched = backend if isinstance(backend, TorqueWatched) else None
        self._reported = False  # a loss of torque or ports has been reported

    def check(self, age: Array, max_age: float) -> None:
        """Check torque, ports, and the ages (n,) s of the joint states against `max_age` s.

        Raises:
            TorqueLostError: A joint has lost its torque since it was armed; raised once.
            PortError: A port is lost, so its joints get no goals; raised once.
            StaleStateError: A joint has not answered for longer than `max_age`.
        """
        if self._watched is not None:
            self._check_torque(self._watched)
        if age.max() > max_age:
            raise self._stale(age, max_age)

    def has_lost_torque(self) -> bool:
        """Return whether a joint has lost its torque, or may have; reads again if in doubt."""
        watched = self._watched
        if watched is None:
            return False
        for _ in range(MAX_REREADS):
            if watched.lost_joints or watched.lost or not watched.doubtful_joints:
                break
            self._backend.read()
        return bool(watched.lost_joints or watched.doubtful_joints)

    def _check_torque(self, watched: TorqueWatched) -> None:
        before, self._reported = self._reported, bool(watched.lost_joints or watched.lost)
        if not self._reported or before:
            return
        if watched.lost_joints:
            raise torque_lost(watched.lost_joints)
        # A port that comes back has to be armed again, so waiting for it is useless.
        names, all_names = watched.doubtful_joints, self._backend.joints.names
        nobody = len(names) == len(all_names) > 1
        what = "no joint can" if nobody else f"{', '.join(names)} cannot"
        raise PortError(f"{what} be reached: {'; '.join(watched.lost.values())}")

    def _stale(self, age: Array, max_age: float) -> StaleStateError:
        """Return the error that names the joint with the oldest state and the remedy."""
        worst = int(np.argmax(age))
        name = self._backend.joints.names[worst]
        others = int((age > max_age).sum()) - 1
        silent = "has not answered for"
        if others:
            silent = f"and {others} more have not answered for"
        doubts = self._watched.doubtful_joints if self._watched is not None else {}
        return StaleStateError(
            f"joint {name!r} {silent} {age[worst]:.2f} s (limit {max_age:.2f} s); "
            f"{doubts.get(name, SILENT)}"
        )
