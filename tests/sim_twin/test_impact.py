"""How hard a trunk hits the floor."""

from math import pi

import mujoco
import numpy as np
import pytest

from windup.robots import RobotDescription
from windup.sim_twin.impact import ImpactGauge
from windup.sim_twin.twin import Twin


def dropped(op3: RobotDescription, height: float, head: bool = False) -> tuple[ImpactGauge, float]:
    """Let a limp op3 fall, its torso `height` m above the floor, onto its back, or onto its head.

    Returns:
        What it shows, and how high its head was above the floor, m.
    """
    twin = Twin(op3)
    twin.lay_down(False, np.zeros(len(op3.joints)))
    if head:
        twin.data.qpos[3:7] = [0.0, 1.0, 0.0, 0.0]
    twin.data.qpos[2] = 1.0
    mujoco.mj_kinematics(twin.model, twin.data)
    torso, skull = twin.data.geom("torso"), twin.data.geom("head")
    lowest = torso.xpos[2] - np.abs(torso.xmat[6:]) @ twin.model.geom("torso").size
    twin.data.qpos[2] -= lowest - height
    drop = skull.xpos[2] - twin.model.geom("head").size[0] - lowest + height
    twin.powered = False
    gauge = ImpactGauge(twin)
    twin.step(round(0.5 / twin.timestep))
    return gauge, float(drop)


def test_a_back_that_falls_freely_hits_as_fast_as_free_fall(op3: RobotDescription) -> None:
    gauge, _ = dropped(op3, 0.1)
    assert gauge.torso == pytest.approx((2.0 * 9.81 * 0.1) ** 0.5, rel=0.1)
    assert gauge.trunk_speed == max(gauge.torso, gauge.head)


def test_a_head_is_told_from_a_torso(op3: RobotDescription) -> None:
    gauge, drop = dropped(op3, 0.2, head=True)
    assert gauge.head == pytest.approx((2.0 * 9.81 * drop) ** 0.5, rel=0.05)
    assert gauge.torso < gauge.head


def test_a_knock_is_what_the_torso_loses_whatever_hit_the_floor(op3: RobotDescription) -> None:
    gauge, _ = dropped(op3, 0.1)
    assert gauge.velocity_jump > 0.7 * gauge.torso


def test_a_robot_that_stands_hits_nothing(op3: RobotDescription) -> None:
    twin = Twin(op3)
    gauge = ImpactGauge(twin)
    twin.step(100)
    assert (gauge.torso, gauge.head, gauge.overload) == (0.0, 0.0, 0.0)
    assert 0.0 < gauge.load.max() < 0.5


def test_the_load_of_a_joint_thrown_back_is_beyond_stall(op3: RobotDescription) -> None:
    twin = Twin(op3)
    gauge = ImpactGauge(twin)
    goals = op3.stance.copy()
    elbow = op3.joints.names.index("l_el")
    goals[elbow] = pi / 2
    twin.set_goals(goals)
    twin.data.qvel[6 + elbow] = -5.0
    twin.step(4)
    assert gauge.most_loaded_joint == "l_el"
    assert gauge.load.max() > 1.2
    assert gauge.overload >= 2 * twin.timestep
