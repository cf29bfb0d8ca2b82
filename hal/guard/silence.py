"""What is said of joints that have not answered for too long."""

import numpy as np

from hal.backend import TorqueWatched
from hal.errors import StaleStateError
from hal.joints import Array, Joints
from hal.torque_loss import SILENT


def stale(
    joints: Joints, age: Array, max_age: float, watched: TorqueWatched | None
) -> StaleStateError:
    """Return the error that names the joint with the oldest state, and what to do about it.

    Args:
        joints: The joints.
        age: (n,) s since each last answered; one at least is above `max_age`.
        max_age: s.
        watched: Their backend, if it knows more than that.
    """
    worst = int(np.argmax(age))
    name = joints.names[worst]
    others = int((age > max_age).sum()) - 1
    who = f"joint {name!r} has" if not others else f"joint {name!r} and {others} more have"
    doubts = watched.doubtful_joints if watched is not None else {}
    return StaleStateError(
        f"{who} not answered for {age[worst]:.2f} s (limit {max_age:.2f} s); "
        f"{doubts.get(name, SILENT)}"
    )
