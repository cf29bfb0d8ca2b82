"""What is measured at every tick of a walk."""

import numpy as np
import pytest

from windup.hal.contacts import ContactSensors
from windup.hal.observation import BaseState, JointState, Observation
from windup.tools.measures.gauges import Gauges

CONTACTS = ContactSensors(("left", "right"), {"left": ("left",), "right": ("right",)})


def seen(time: float, down: tuple[bool, bool] = (True, True), turning: float = 0.0) -> Observation:
    one = np.ones(2)
    joints = JointState(one, np.array([1.0, -2.0]), np.array([3.0, 4.0]), one, one, one)
    base = BaseState(np.zeros(3), np.array([1.0, 0, 0, 0]), np.zeros(3), np.array([0, turning, 0]))
    return Observation(time, joints, None, 9.0 * np.array(down, dtype=float), base)


def test_a_flight_ends_with_a_touch_and_chatter_is_none() -> None:
    gauges = Gauges(CONTACTS)
    both, left, air = (True, True), (True, False), (False, False)
    for tick, down in enumerate([both, air, both, left, air, air, air, left, air, air, air, air]):
        gauges.update(seen(0.01 * tick, down))
    assert gauges.flights == 1
    assert gauges.flight_time == pytest.approx(0.03)


def test_a_skip_touches_twice_with_each_foot() -> None:
    gauges = Gauges(CONTACTS)
    air, left, right = (False, False), (True, False), (False, True)
    order = [left, right, right, left, left, right, right]
    for tick, down in enumerate(down for foot in order for down in (air, air, air, foot)):
        gauges.update(seen(0.01 * tick, down))
    assert gauges.touchdowns == [0, 1, 1, 0, 0, 1, 1]
    assert gauges.skips == 1.0
    gauges.touchdowns += [0, 1, 0]  # it falls into a run
    assert gauges.skips == pytest.approx(6 / 8)


def test_work_has_no_sign_and_shake_is_a_root_mean_square() -> None:
    gauges = Gauges(CONTACTS)
    for tick in range(11):
        gauges.update(seen(0.01 * tick, turning=2.0 if tick % 2 else 0.0))
    assert gauges.work == pytest.approx(0.1 * (3.0 + 8.0))
    assert gauges.angular_velocity_rms == pytest.approx(np.sqrt(2.0))
    assert gauges.cost_of_transport(2.0, 0.5) == pytest.approx(1.1 / (2.0 * 9.81 * 0.5))
    assert gauges.cost_of_transport(2.0, 0.0) is None
