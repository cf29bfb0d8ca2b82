"""Falling well."""

from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest

from tests.control.biped import DT, observed, robot_state
from windup.control.falling.fall import FallPredictor
from windup.control.falling.protection import (
    EFFORT,
    LONGEST,
    REST,
    Phase,
    Protected,
    ProtectiveFall,
    bounded,
)
from windup.control.motions.play import PoseHolder
from windup.hal.command import joint_torque
from windup.hal.joints import Array, Joint, Joints
from windup.hal.observation import BaseState, Observation
from windup.hal.publishing.controller_block import ControllerBlock
from windup.hal.publishing.run_state import RunState

JOINTS = Joints(
    tuple(
        Joint(name, lower=-2.0, upper=2.0, stiffness=20.0, damping=0.8, torque=4.0)
        for name in ("left", "right")
    )
)
FORWARD, BACK = np.array([0.1, 0.1]), np.array([-0.1, -0.1])
HALF = np.array([0.5, 0.5])
SOFT = np.array([0.1, 0.2])
WAYS = [ProtectiveFall(0.0, FORWARD, HALF, SOFT, 1.3), ProtectiveFall(pi, BACK, HALF, SOFT, 1.3)]


def leaning(time: float, pitch: float, rate: float = 0.0) -> Observation:
    orientation = np.array([cos(0.5 * pitch), 0.0, sin(0.5 * pitch), 0.0])
    rates = np.array([0.0, rate, 0.0])
    base = BaseState(np.array([0.0, 0.0, 0.25]), orientation, np.zeros(3), rates)
    return replace(observed(time), base=base)


def protected() -> Protected:
    controller = PoseHolder(JOINTS, np.zeros(2), ramp=0.0)
    return Protected(controller, FallPredictor(robot_state(), 0.05), WAYS, JOINTS)


class Fall:
    """Plays observations to a protected controller."""

    def __init__(self) -> None:
        self.protected, self.time = protected(), 0.0
        self.protected.reset(leaning(0.0, 0.0))

    def hold(self, seconds: float, pitch: float, rate: float = 0.0) -> Array:
        """Return the last command (5, n)."""
        for _ in range(round(seconds / DT)):
            self.time += DT
            command = self.protected.step(leaning(self.time, pitch, rate), DT)
        return command.block


def test_without_a_fall_its_controller_does_as_it_likes() -> None:
    fall = Fall()
    block = fall.hold(0.2, 0.1)
    assert (fall.protected.phase, fall.protected.way) == (Phase.SAFE, None)
    assert block[0] == pytest.approx([0.0, 0.0])
    assert block[3] == pytest.approx(JOINTS.stiffness)


def test_the_phases_of_a_fall_are_published_after_the_controllers_own() -> None:
    fall = Fall()
    names = fall.protected.published
    block = ControllerBlock.of(names)
    for seconds, pitch, rate, running, phase in (
        (0.1, 0.1, 0.0, RunState.STANDING, ""),
        (0.05, 1.2, 5.0, RunState.FALLING, "falling"),
        (0.05, 1.44, 5.0, RunState.FALLING, "impact"),
        (REST + 3 * DT, 1.5, 0.0, RunState.FALLEN, "lying"),
    ):
        fall.hold(seconds, pitch, rate)
        fall.protected.publish(block)
        assert block.run_state is running
        assert not phase or names.phases[block.phase] == phase
        assert not phase or names.reasons[block.reason] == "a fall cannot be prevented"


@pytest.mark.parametrize(("pitch", "pose"), [(1.2, FORWARD), (-1.2, BACK)])
def test_it_takes_the_pose_of_that_side_and_grows_soft_before_the_floor(
    pitch: float, pose: Array
) -> None:
    fall = Fall()
    falling = fall.hold(0.05, pitch, 5.0)
    assert fall.protected.phase.value == "falling"
    assert falling[0] == pytest.approx(pose)
    assert falling[3] == pytest.approx(0.5 * JOINTS.stiffness)
    impact = fall.hold(0.05, 1.2 * pitch, 5.0)
    assert fall.protected.phase.value == "impact"
    assert impact[3] == pytest.approx(SOFT * JOINTS.stiffness)


def test_it_is_over_once_the_robot_lies_still_and_not_while_it_rolls() -> None:
    fall = Fall()
    fall.hold(1.0, 1.5, 1.0)
    assert fall.protected.active and not fall.protected.finished
    fall.hold(REST + 3 * DT, 1.5)
    assert fall.protected.finished


def test_a_fall_that_does_not_come_is_waited_for_only_so_long() -> None:
    fall = Fall()
    fall.hold(LONGEST - 0.1, 1.2)
    assert not fall.protected.finished
    fall.hold(0.2, 1.2)
    assert fall.protected.finished


def test_it_can_be_used_again() -> None:
    fall = Fall()
    fall.hold(0.1, 1.2)
    fall.protected.reset(leaning(9.0, 0.0))
    assert not fall.protected.active


@pytest.mark.parametrize("speed", [-4.0, 0.0, 4.0])
@pytest.mark.parametrize("pose", [-1.0, 0.05, 1.0])
def test_no_joint_is_asked_for_more_than_it_can_bear(speed: float, pose: float) -> None:
    state = replace(observed(0.0, leg=np.zeros(2), leg_rate=np.full(2, speed)).joints)
    wanted = np.full(2, pose)
    command = bounded(JOINTS, wanted, np.ones(2), state)
    torque = joint_torque(command, state.position, state.velocity, np.full(2, np.inf))
    assert (np.abs(torque) <= EFFORT * JOINTS.torque + 1e-9).all()
    within = np.abs(20.0 * pose - 0.8 * speed) <= EFFORT * 4.0
    assert (command.position == pytest.approx(wanted)) == bool(within)
