"""When to step, with which foot, and where to: pure functions of momenta and feet.

Wu & Zordan 2010, sections 4.1 to 4.3. Their damping values for a human (4 and 6 for `when`, 9 and
18 for `where`) are given here as multiples of omega = sqrt(g / c_z), so that they also hold for
small robots, which fall faster.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import cos, exp, sin
from typing import Final

import numpy as np
from shapely.geometry.base import BaseGeometry

from windup.control.kinematics.momenta import Momenta, capture_point, desired_cp
from windup.control.kinematics.support import SupportRegion, convex_hull, nearest_point
from windup.hal.errors import UnknownNameError
from windup.hal.joints import Array

Damping = tuple[float, float]
AGAIN: Final = 0.25
"""Penalty on `Placement.uncaught` for a second step with the same foot in a row, m."""


@dataclass(frozen=True)
class StepRule:
    """Damping values by which steps are triggered and placed.

    Attributes:
        name: Name of the rule.
        when: Damping of linear and angular momentum for the trigger point, which has to stay in
            the support, in multiples of omega.
        where: The same for the landing point; None for the predicted capture point.
    """

    name: str
    when: Damping
    where: Damping | None


RULES: Final[Mapping[str, StepRule]] = {
    rule.name: rule
    for rule in (
        StepRule("momentum", when=(1.3, 1.9), where=(2.9, 5.7)),  # (4, 6) and (9, 18) at 3.13 1/s
        StepRule("ip", when=(1.3, 0.0), where=(2.9, 0.0)),
        StepRule("capture", when=(1.0, 0.0), where=(1.0, 0.0)),
        StepRule("predictive", when=(1.0, 0.0), where=None),
    )
}


def find_rule(name: str) -> StepRule:
    """Return the built-in rule `name`.

    Raises:
        UnknownNameError: There is no such rule.
    """
    if name not in RULES:
        raise UnknownNameError("step rule", name, RULES)
    return RULES[name]


def trigger_point(rule: StepRule, body: Momenta) -> Array:
    """Return the trigger point (2,) m; a step is needed once it leaves the support."""
    linear, angular = rule.when
    return desired_cp(body, linear * body.omega, angular * body.omega)


def landing_point(rule: StepRule, body: Momenta, pivot: Array, left: float) -> Array:
    """Return the desired landing point (2,) of the foot, m.

    Args:
        rule: The rule.
        body: The momenta.
        pivot: (2,) centre of pressure during the swing, m.
        left: Time until the foot lands, s.
    """
    if rule.where is None:
        return coming_point(body, pivot, left)
    linear, angular = rule.where
    return desired_cp(body, linear * body.omega, angular * body.omega)


def coming_point(body: Momenta, pivot: Array, left: float) -> Array:
    """Return the capture point (2,) m predicted for T = `left` s: p + (xi - p) e^(omega T).

    The centre of pressure p, `pivot`, is assumed constant.
    """
    return np.asarray(pivot + (capture_point(body) - pivot) * exp(body.omega * left))


@dataclass(frozen=True)
class Reach:
    """Bounds of a foot's place relative to the other foot: no crossing, within the leg's reach.

    Attributes:
        back: Minimum forward position, m (negative).
        front: Maximum forward position, m.
        near: Minimum lateral distance, m.
        far: Maximum lateral distance, m.
    """

    back: float
    front: float
    near: float
    far: float

    def region(self, stance: Array, yaw: float, side: int) -> BaseGeometry:
        """Return the region for the foot on `side` (+1 left) beside the one at `stance` (2,)."""
        forward = np.array([cos(yaw), sin(yaw)])
        outward = side * np.array([-sin(yaw), cos(yaw)])
        corners = [(x, y) for x in (self.back, self.front) for y in (self.near, self.far)]
        points = [stance[:2] + x * forward + y * outward for x, y in corners]
        return convex_hull(np.array(points))


@dataclass(frozen=True)
class Placement:
    """A possible step.

    Attributes:
        foot: Index of the foot.
        target: (2,) landing place of the sole's centre, m.
        missed: Distance of `target` from the desired landing point, m.
        uncaught: Distance of the nearest place within reach from the predicted capture point, m.
    """

    foot: int
    target: Array
    missed: float
    uncaught: float = 0.0


def place(
    foot: int, wanted: Array, region: BaseGeometry, forbidden: Sequence[BaseGeometry] = ()
) -> Placement | None:
    """Return the allowed place nearest to `wanted` (2,), or None if no place is allowed.

    Kenwright 2012, section IV-A.4: a target in a hole is replaced by the closest allowed point;
    the next step corrects what this one cannot.
    """
    for hole in forbidden:
        region = region.difference(hole)
    if region.is_empty:
        return None
    target = nearest_point(region, wanted)
    return Placement(foot, target, float(np.linalg.norm(target - wanted)))


def choose(
    candidates: Sequence[Placement], feet: Array, wanted: Array, landed: int | None = None
) -> Placement:
    """Return the placement with the least `uncaught`, then least `missed`, then nearest foot.

    The paper takes the nearest foot (section 4.2). After a wide step that is often the one that
    has just landed; pivoting about the other, far behind, the body would only fall faster.

    Args:
        candidates: One placement for each foot that may step.
        feet: (k, 2) present positions of the feet, m.
        wanted: (2,) desired landing point, m.
        landed: The foot that has just landed, or None.
    """
    able = _least(candidates, lambda c: c.uncaught + AGAIN * (c.foot == landed), 0.01)
    good = _least(able, lambda c: c.missed, 0.005)
    return min(good, key=lambda c: float(np.linalg.norm(feet[c.foot, :2] - wanted)))


def _least(
    candidates: Sequence[Placement], size: Callable[[Placement], float], margin: float
) -> list[Placement]:
    least = min(map(size, candidates))
    return [candidate for candidate in candidates if size(candidate) <= least + margin]


def needs_step(point: Array, support: SupportRegion, slack: float = 0.0) -> bool:
    """Return whether `point` (2,) has left the support by more than `slack` m (section 4.1)."""
    return support.margin(point) < -slack
