"""Interpolation between gaits: beta(a B1 + (1 - a) B2), Laszlo 1996, section 5.4.

B1 + a (B2 - B1) is the graph B1 under the perturbation B2 - B1, scaled by a. So a blend is a style:
its amount is ramped from step to step, it adds to other styles, and the first gait's balance
control applies to it.
"""

from dataclasses import replace

import msgspec
import numpy as np

from windup.control.pose_graph.gait import Gait
from windup.control.pose_graph.gait_file import Balance, Perturbation, Style

STEPS = 18.0  # steps of the ramp from one gait to the other


def with_blend(gait: Gait, other: Gait) -> Gait:
    """Return `gait` with an additional style, `blend_name`, that turns it into `other`.

    The style changes poses, hold times and targets; perturbations, sampling and tables stay.

    Raises:
        ConfigError: The graphs have different states.
    """
    name = blend_name(other.name)
    change = other.graph - gait.graph
    style = Style(
        name=name, scale={name: 1.0}, targets=_further(gait, other), steps=STEPS, most=1.0
    )
    item = Perturbation(name=name, limit=1.0)
    file = msgspec.structs.replace(
        gait.file,
        perturbation=[*gait.file.perturbation, item],
        style=[*gait.file.style, style],
    )
    return replace(
        gait,
        file=file,
        perturbations=(*gait.perturbations, name),
        pose_change=np.concatenate([gait.pose_change, change.pose[None]]),
        hold_change=np.concatenate([gait.hold_change, change.hold[None]]),
    )


def blend_name(other: str) -> str:
    """Return the name of the style that turns a gait into `other`; gait files use no such names."""
    return f"blend {other}"


def _further(gait: Gait, other: Gait) -> dict[str, float]:
    """Return the targets of `other` minus those of `gait`, for names that both have."""
    mine, theirs = (one.file.balance or Balance() for one in (gait, other))
    shared = [name for name in mine.targets if name in theirs.targets]
    return {name: theirs.targets[name] - mine.targets[name] for name in shared}
