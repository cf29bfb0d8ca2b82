"""When to step, with which foot, and where to: pure functions of momenta and feet.

Wu & Zordan 2010, sections 4.1 to 4.3. Their damping values for a human (4 and 6 for when, 9 and 18
for where) are given here as multiples of omega = sqrt(g / c_z), so that small robots, which fall
faster, have them too.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import cos, exp, sin
from typing import Final

import numpy as np
from shapely import MultiPoint
from shapely.geometry.base import BaseGeometry

from windup.control.kinematics.momenta import Momenta, capture_point, desired_cp
from windup.control.kinematics.support import SupportRegion, nearest_point
from windup.hal.errors import UnknownNameError
from windup.hal.joints import Array

Damping = tuple[float, float]
AGAIN: Final = 0.25
"""How much better the same foot has to catch a fall to step twice in a row, m."""


@dataclass(frozen=True)
class StepRule:
    """One way to decide.

    Attributes:
        name: What people call it.
        when: Damping of linear and angular momentum of the point that has to stay in the support,
            in omega.
        where: The same of the point that is stepped to; None for the predictive placement.
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
    """Return a rule by its name.

    Raises:
        UnknownNameError: There is no such rule.
    """
    if name not in RULES:
        raise UnknownNameError("step rule", name, RULES)
    return RULES[name]


def trigger_point(rule: StepRule, body: Momenta) -> Array:
    """Return the point (2,) m that lies in the support as long as no step is needed."""
    linear, angular = rule.when
    return desired_cp(body, linear * body.omega, angular * body.omega)


def landing_point(rule: StepRule, body: Momenta, pivot: Array, left: float) -> Array:
    """Return where (2,) m the foot should come down.

    Args:
        rule: The rule.
        body: The momenta.
        pivot: (2,) where the ground pushes during the swing, m.
        left: Time until the foot lands, s.
    """
    if rule.where is None:
        return coming_point(body, pivot, left)
    linear, angular = rule.where
    return desired_cp(body, linear * body.omega, angular * body.omega)


def coming_point(body: Momenta, pivot: Array, left: float) -> Array:
    """Return the capture point (2,) m in `left` s, p + (xi - p) e^(omega T), about a pivot."""
    return np.asarray(pivot + (capture_point(body) - pivot) * exp(body.omega * left))


@dataclass(frozen=True)
class Reach:
    """Where a foot may be put, seen from the other: no crossing, no farther than the leg.

    Attributes:
        back: Farthest behind the other foot, m (negative).
        front: Farthest before it, m.
        near: Nearest beside it, m.
        far: Farthest beside it, m.
    """

    back: float
    front: float
    near: float
    far: float

    def region(self, stance: Array, yaw: float, side: int) -> BaseGeometry:
        """Return where the foot on `side` (+1 left) may land beside the one at `stance` (2,)."""
        forward = np.array([cos(yaw), sin(yaw)])
        outward = side * np.array([-sin(yaw), cos(yaw)])
        corners = [(x, y) for x in (self.back, self.front) for y in (self.near, self.far)]
        points = [stance[:2] + x * forward + y * outward for x, y in corners]
        return MultiPoint(np.array(points)).convex_hull


@dataclass(frozen=True)
class Placement:
    """A step that has been decided.

    Attributes:
        foot: Which foot.
        target: (2,) where its sole's centre comes down, m.
        missed: How far that is from where it should, m.
        uncaught: How far the best place within reach is from the coming capture point, m.
    """

    foot: int
    target: Array
    missed: float
    uncaught: float = 0.0


def place(
    foot: int, wanted: Array, region: BaseGeometry, forbidden: Sequence[BaseGeometry] = ()
) -> Placement | None:
    """Return the nearest allowed place to `wanted` (2,), or None where nothing is allowed.

    Kenwright 2012, section IV-A.4: instead of a hole the next closest point; what that does not
    mend the next decision will.
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
    """Return whose foot can catch the fall, then what misses least, then the nearest foot.

    The paper takes the nearest foot (section 4.2). After a wide step that is often the one that
    has just landed, and about the other, far behind, the body would only fall faster.

    Args:
        candidates: One for each foot that may step.
        feet: (k, 2) where the feet are, m.
        wanted: (2,) where one should come down, m.
        landed: The foot that has just come down, if one has.
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
