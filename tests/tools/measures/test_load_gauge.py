from dataclasses import replace

import numpy as np
import pytest

from tests.small_world import JOINTS, N, observation
from windup.tools.measures.load_gauge import LoadGauge


def looked(shares: list[list[float]]) -> LoadGauge:
    gauge = LoadGauge(JOINTS)
    for tick, share in enumerate(shares):
        seen = observation(0.1 * tick)
        torque = np.array(share) * JOINTS.torque
        gauge.update(replace(seen, joints=replace(seen.joints, torque=torque)))
    return gauge


def test_the_highest_load_and_its_joint_are_kept() -> None:
    gauge = looked([[0.1, 0, 0, 0, 0], [0, 0, -0.7, 0, 0], [0, 0.2, 0, 0, 0]])
    assert gauge.peak == pytest.approx(0.7)
    assert gauge.joint == "l_knee"


def test_time_above_half_counts_for_one_joint_without_a_break() -> None:
    rest, one, other = [0.0] * N, [0.6, 0, 0, 0, 0], [0, 0.6, 0, 0, 0]
    assert looked([rest, one, one, one, rest, one]).high_time == pytest.approx(0.3)
    assert looked([rest, one, other, one, other]).high_time == pytest.approx(0.1)


def test_joints_that_measure_no_torque_have_no_load() -> None:
    gauge = looked([[np.nan] * N] * 3)
    assert np.isnan(gauge.peak)
    assert (gauge.joint, gauge.high_time) == ("", 0.0)
