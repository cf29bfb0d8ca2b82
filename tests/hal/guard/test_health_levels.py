from dataclasses import replace

import numpy as np
import pytest

from windup.hal.families import servo_model, servo_names
from windup.hal.guard import HealthKind, HealthLevels
from windup.hal.guard.levels import defaults
from windup.hal.servos.servo_model import ServoMount
from windup.robots import load_robot, robot_names

SUPPLIES = {
    **dict.fromkeys(("XC330-M288", "XL330-M288", "XL330-M077"), 5.0),
    **{"STS3215-7.4V": 7.4, "SCS0009": 6.0},
}


@pytest.mark.parametrize("name", servo_names())
def test_a_servo_is_stopped_before_it_protects_itself(name: str) -> None:
    model, supply = servo_model(name), SUPPLIES.get(name, 12.0)
    assert model.limits is not None
    levels = defaults(model, supply)
    low, high = levels[HealthKind.SUPPLY_LOW], levels[HealthKind.SUPPLY_HIGH]
    assert model.limits.low < low[1] <= low[0] < supply < high[0] <= high[1] <= model.limits.high
    warm, hot = levels[HealthKind.TEMPERATURE]
    assert warm < hot < model.limits.temperature
    for kind in (HealthKind.LOAD, HealthKind.STALL):
        assert 0.0 < levels[kind][0] < levels[kind][1]


def test_a_servo_without_published_limits_counts_as_the_most_delicate() -> None:
    model = replace(servo_model("XM430-W350"), limits=None)
    assert defaults(model, 12.0)[HealthKind.TEMPERATURE] == (55.0, 62.0)
    assert defaults(model, 12.0)[HealthKind.SUPPLY_LOW] == pytest.approx((10.8, 9.6))


def test_what_the_robot_states_wins_at_every_joint() -> None:
    mounts = [ServoMount(servo_model(name), "a", 1, 1, 0, 2.0) for name in ("AX-12A", "MX-28")]
    levels = HealthLevels.of(mounts, 12.0, {HealthKind.TEMPERATURE: (50.0, 55.0)})
    np.testing.assert_array_equal(levels.warn[HealthKind.TEMPERATURE], [50.0, 50.0])
    np.testing.assert_array_equal(levels.stop[HealthKind.TEMPERATURE], [55.0, 55.0])
    np.testing.assert_allclose(levels.torque, [3.0, 5.0])  # at the joint


def test_an_ideal_joint_is_never_unwell() -> None:
    levels = HealthLevels.of([None], 12.0)
    assert np.isnan(levels.warn).all() and np.isnan(levels.stop).all()
    assert levels.torque == np.inf


@pytest.mark.parametrize("name", robot_names())
def test_every_robot_is_well_on_a_full_battery_and_on_its_nominal_supply(name: str) -> None:
    robot = load_robot(name)
    driven = np.array([servo is not None for servo in robot.servos])
    low, high = robot.health.warn[HealthKind.SUPPLY_LOW], robot.health.warn[HealthKind.SUPPLY_HIGH]
    assert (low[driven] < robot.drive.supply).all()
    assert (high[driven] > robot.drive.supply).all()
