import numpy as np
import pytest
import shapely

from windup.control.kinematics.momenta import Momenta, capture_point
from windup.control.kinematics.support import SupportRegion
from windup.control.stepping.step_decision import (
    RULES,
    Placement,
    Reach,
    choose,
    coming_point,
    find_rule,
    landing_point,
    needs_step,
    place,
    trigger_point,
)
from windup.hal.errors import UnknownNameError

FEET = np.array([[0.0, 0.05], [0.0, -0.05]])
SOLES = SupportRegion.hull(np.array([[x, y, 0.0] for x in (-0.06, 0.06) for y in (-0.09, 0.09)]))
REACH = Reach(back=-0.1, front=0.12, near=0.06, far=0.16)


def pushed(speed: float, spin: float = 0.0) -> Momenta:
    return Momenta(
        3.0, np.array([0.0, 0.0, 0.25]), np.array([speed, 0.0, 0.0]), np.array([0.0, spin, 0.0])
    )


@pytest.mark.parametrize("name", RULES)
def test_standing_still_needs_no_step_and_a_fall_needs_one(name: str) -> None:
    rule = find_rule(name)
    assert not needs_step(trigger_point(rule, pushed(0.0)), SOLES)
    assert needs_step(trigger_point(rule, pushed(0.8)), SOLES)


def test_a_rule_that_nobody_knows_is_answered_with_those_there_are() -> None:
    with pytest.raises(UnknownNameError, match="momentum"):
        find_rule("magic")


def test_momentum_sees_the_turning_that_the_pendulum_does_not() -> None:
    slow, turning = pushed(0.2), pushed(0.2, spin=0.4)
    assert not needs_step(trigger_point(RULES["ip"], turning), SOLES)
    assert needs_step(trigger_point(RULES["momentum"], turning), SOLES)
    assert not needs_step(trigger_point(RULES["momentum"], slow), SOLES)


def test_prediction_lands_where_the_capture_point_will_be() -> None:
    body, pivot = pushed(0.5), np.array([0.06, 0.0])
    now = capture_point(body)
    at = landing_point(RULES["predictive"], body, pivot, 0.2)
    assert at - pivot == pytest.approx((now - pivot) * np.exp(0.2 * body.omega))
    assert landing_point(RULES["predictive"], body, pivot, 0.0) == pytest.approx(now)


def test_a_foot_crosses_nothing_and_goes_no_farther_than_the_leg() -> None:
    region = REACH.region(FEET[1], 0.0, +1)
    far = place(0, np.array([0.5, 0.0]), region)
    assert far is not None
    assert far.target == pytest.approx([0.12, 0.01])
    assert far.missed == pytest.approx(np.hypot(0.38, 0.01))
    crossed = place(0, np.array([0.0, -0.3]), region)
    assert crossed is not None
    assert crossed.target[1] == pytest.approx(0.01)


def test_reach_turns_with_the_body() -> None:
    region = REACH.region(np.zeros(2), np.pi / 2, +1)
    left_of_a_body_that_faces_left = shapely.Point(-0.1, 0.0)
    assert region.covers(left_of_a_body_that_faces_left)
    assert not region.covers(shapely.Point(0.1, 0.0))


def test_a_hole_gives_the_nearest_place_beside_it() -> None:
    region = REACH.region(FEET[1], 0.0, +1)
    wanted = np.array([0.05, 0.05])
    hole = shapely.box(0.0, -0.2, 0.08, 0.2)
    beside = place(0, wanted, region, [hole])
    assert beside is not None
    assert beside.target == pytest.approx([0.08, 0.05])
    assert place(0, wanted, region, [shapely.box(-1, -1, 1, 1)]) is None


def test_the_foot_that_misses_least_steps_and_of_two_alike_the_nearest() -> None:
    wanted = np.array([0.0, 0.1])
    left = place(0, wanted, REACH.region(FEET[1], 0.0, +1))
    right = place(1, wanted, REACH.region(FEET[0], 0.0, -1))
    assert left is not None
    assert right is not None
    assert choose([left, right], FEET, wanted).foot == 0
    alike = [type(left)(k, wanted, 0.0) for k in (0, 1)]
    assert choose(alike, FEET, np.array([0.0, -0.08])).foot == 1


def test_the_foot_that_can_catch_the_fall_steps_and_not_twice_the_same() -> None:
    wanted = np.array([0.0, 0.3])
    landed = Placement(0, wanted, missed=0.0, uncaught=0.4)
    behind = Placement(1, np.array([0.0, 0.1]), missed=0.2, uncaught=0.0)
    assert choose([landed, behind], FEET, wanted).foot == 1
    alike = [Placement(0, wanted, 0.0), Placement(1, wanted, 0.1, uncaught=0.1)]
    assert choose(alike, FEET, wanted).foot == 0
    assert choose(alike, FEET, wanted, landed=0).foot == 1


def test_the_capture_point_runs_away_from_the_pivot() -> None:
    body = pushed(0.5)
    pivot, now = np.zeros(2), capture_point(body)
    assert coming_point(body, pivot, 0.0) == pytest.approx(now)
    assert coming_point(body, pivot, 0.2) == pytest.approx(now * np.exp(0.2 * body.omega))
