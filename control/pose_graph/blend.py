"""Interpolation between gaits: beta(a B1 + (1 - a) B2), Laszlo 1996, section 5.4.

B1 + a (B2 - B1) is the graph B1 under the perturbation B2 - B1, scaled by a. So a blend is a style:
it comes in a little each step, composes with others, and the first gait's balance holds it up.
"""

from dataclasses import replace

import msgspec
import numpy as np

from windup.control.pose_graph.gait import Gait
from windup.control.pose_graph.gait_file import Balance, Perturbation, Style

STEPS = 18.0  # from one gait to the other


def with_blend(gait: Gait, other: Gait) -> Gait:
    """Return `gait` with a style that turns it into `other`; `blend_name` is its name.

    The other's poses, hold times and targets come in; perturbations, sampling and tables stay.

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
    """Return the name of the style that turns a gait into `other`; no file has such names."""
    return f"blend {other}"


def _further(gait: Gait, other: Gait) -> dict[str, float]:
    """Return what the targets of `other` are above those of `gait`, where both have them."""
    mine, theirs = (one.file.balance or Balance() for one in (gait, other))
    shared = [name for name in mine.targets if name in theirs.targets]
    return {name: theirs.targets[name] - mine.targets[name] for name in shared}
