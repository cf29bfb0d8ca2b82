"""Joints that are not there any more, as the guard sees them."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import pytest

from tests.small_world import JOINTS, FakeBackend, N
from windup.hal.errors import PortError, StaleStateError, TorqueLostError
from windup.hal.guard import GuardedBackend, SafetyLimits
from windup.hal.observation import Observation
from windup.hal.torque_loss import SWITCHED_OFF, Loss

GONE = "port x was disconnected"


@dataclass
class Watched(FakeBackend):
    """Joints whose torque is watched, and doubted for some reads."""

    lost_joints: Mapping[str, Loss] = field(default_factory=dict)
    lost: Mapping[str, str] = field(default_factory=dict)
    doubts: int = 0

    @property
    def doubtful_joints(self) -> Mapping[str, str]:
        if self.lost:
            return dict.fromkeys(JOINTS.names, GONE)
        return {"l_knee": "check its cable"} if self.doubts > 0 else {}

    def collect(self) -> Observation:
        self.doubts -= 1
        return super().collect()


def guarded(backend: Watched) -> GuardedBackend:
    limits = SafetyLimits.of(backend.joints)
    return GuardedBackend(backend, limits, "crouch", crouch=np.full(N, 0.3))


def test_a_joint_without_torque_ends_a_run_once() -> None:
    backend = Watched()
    guard = guarded(backend)
    guard.read()
    backend.lost_joints = {"l_knee": SWITCHED_OFF}
    with pytest.raises(
        TorqueLostError, match="l_knee lost its torque: another program switched it off"
    ):
        guard.read()
    guard.read()
    backend.lost_joints = {}
    guard.read()
    backend.lost_joints = {"l_hip": SWITCHED_OFF}
    with pytest.raises(TorqueLostError, match="l_hip"):
        guard.read()


def test_a_port_that_is_gone_ends_a_run_at_once_with_the_joints_behind_it() -> None:
    backend = Watched(lost={"x": GONE})
    with pytest.raises(PortError, match=r"^no joint can be reached: port x was disconnected$"):
        guarded(backend).read()


def test_what_is_known_of_a_silent_joint_is_said() -> None:
    backend = Watched(doubts=9, age=np.array([0.0, 0.0, 0.5, 0.0, 0.4]))
    said = r"joint 'l_knee' and 1 more have not answered for 0.50 s \(.*\); check its cable$"
    with pytest.raises(StaleStateError, match=said):
        guarded(backend).read()


def test_a_robot_with_a_joint_that_is_not_there_goes_limp_at_once() -> None:
    for backend in (Watched(lost_joints={"l_hip": SWITCHED_OFF}), Watched(doubts=99)):
        assert guarded(backend).stop().all_off
        assert backend.written == [] and not backend.powered


def test_answers_that_were_lost_a_moment_ago_are_no_reason_to_leave_out_a_crouch() -> None:
    backend = Watched(doubts=2)
    assert guarded(backend).stop().all_off
    assert backend.written[-1].position == pytest.approx(np.full(N, 0.3), abs=0.01)
