"""What the guard has clipped so far, in words."""

import numpy as np

from windup.hal.command import FIELDS
from windup.hal.guard.guarded import GuardedBackend


def clamp_text(guard: GuardedBackend) -> str:
    """Return what was clipped, such as "position of head_pan was clipped in 486 ticks", or "".

    Of several joints, the one that was clipped most often is named.
    """
    said = []
    for name, counts in zip(FIELDS, guard.clamp_counts, strict=True):
        if not counts.any():
            continue
        most, others = int(counts.argmax()), int(np.count_nonzero(counts)) - 1
        also = f" (and of {others} other joint{'s' * (others > 1)})" if others else ""
        ticks = int(counts[most])
        said.append(
            f"{name} of {guard.joints.names[most]}{also} was clipped in {ticks} "
            f"tick{'s' * (ticks > 1)}"
        )
    return "; ".join(said)
