"""Ground that soles keep off."""

import numpy as np
import pytest
from shapely import Point, Polygon, box

from windup.control.footprints.keep_out import KeepOutRegions, grown, placed, shadow
from windup.control.kinematics.limb_ik import Pose
from windup.control.kinematics.rotation import turn
from windup.hal.errors import UsageError

SOLE = np.array([[x, y] for x in (-0.06, 0.06) for y in (-0.03, 0.03)])


def stand(no_step: KeepOutRegions, yaw: float = 0.0) -> None:
    """Let two feet stand 0.1 m apart about (1, 2), turned by `yaw` rad."""
    turned = turn(yaw)
    feet = [Pose(np.array([1.0, 2.0, 0.0]) + turned @ [0.0, y, 0.0], turned) for y in (0.05, -0.05)]
    soles = [foot.position + np.column_stack([SOLE, np.zeros(4)]) @ turned.T for foot in feet]
    no_step.begin(feet, soles)


def test_a_sole_keeps_off_with_its_edges_not_with_its_centre_alone() -> None:
    hole = grown(box(0.1, 0.0, 0.2, 0.1), SOLE)
    assert hole.bounds == pytest.approx((0.04, -0.03, 0.26, 0.13))
    assert grown(box(0.1, 0.0, 0.2, 0.1), SOLE, 0.01).bounds == pytest.approx(
        (0.03, -0.04, 0.27, 0.14)
    )


def test_the_notch_of_a_bent_region_stays_free() -> None:
    bent = Polygon([(0, 0), (1, 0), (1, 1), (0.9, 1), (0.9, 0.1), (0, 0.1)])
    assert not grown(bent, SOLE).contains(Point(0.4, 0.6))
    assert grown(bent, SOLE).contains(Point(0.85, 0.6))


def test_regions_lie_where_the_robot_started_and_how_it_faced() -> None:
    no_step = KeepOutRegions([box(0.2, -0.01, 0.3, 0.01)])
    stand(no_step, np.pi / 2)
    (there,) = no_step.here
    assert there.bounds == pytest.approx((0.99, 2.2, 1.01, 2.3))
    start = np.array([1.0, 2.0])
    assert not no_step.allows(0, np.pi / 2, start, np.array([1.0, 2.25]))
    assert no_step.allows(0, np.pi / 2, start, np.array([1.25, 2.0]))
    assert placed(box(0, 0, 1, 1), np.array([1.0, 0.0, 0.0])).bounds == (1.0, 0.0, 2.0, 1.0)


def test_a_foot_that_comes_down_short_of_its_target_does_not_do_so_in_a_hole() -> None:
    hole = box(0.1, -1.0, 0.2, 1.0)
    behind = shadow(hole, np.zeros(2))
    assert behind.contains(Point(0.25, 0.0))  # at 75 % of the way it would be in
    assert not behind.contains(Point(0.35, 0.0))
    assert not behind.contains(Point(0.08, 0.0))


def test_holes_follow_the_heading_of_the_foot_and_where_it_starts() -> None:
    no_step = KeepOutRegions([box(0.2, -1.0, 0.3, 1.0)])
    stand(no_step)
    start = np.array([1.0, 2.0])
    (along,) = no_step.holes(0, 0.0, start)
    (across,) = no_step.holes(0, np.pi / 2, start)
    short = 1.0 + 0.15 / 1.1  # a sole of 0.12 m along, and the longest that it may come down
    assert along.bounds[0] == pytest.approx(1.0 + 0.14 / 1.1, abs=0.01)
    assert across.bounds[0] == pytest.approx(short + 0.02, abs=0.01)
    (nearer,) = no_step.holes(0, 0.0, start + np.array([0.1, 0.0]))
    assert nearer.bounds[0] > along.bounds[0]


def test_who_forbids_nothing_has_no_holes() -> None:
    no_step = KeepOutRegions()
    stand(no_step)
    assert not no_step
    assert no_step.holes(0, 0.0, np.zeros(2)) == []


def test_who_stands_on_forbidden_ground_is_told() -> None:
    with pytest.raises(UsageError, match="forbidden ground at the start"):
        stand(KeepOutRegions([box(-0.1, -0.1, 0.1, 0.1)]))
