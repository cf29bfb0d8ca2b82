from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from tests.hal import servo_state
from tests.small_world import JOINTS, FakeBackend, N
from windup.hal.command import FIELDS, JointCommand
from windup.hal.errors import (
    HardwareError,
    StaleStateError,
    TorqueUnknownError,
    UnhealthyError,
    UnsafeCommandError,
)
from windup.hal.guard import GuardedBackend, SafetyLimits, StopPolicy
from windup.hal.joints import Joint, Joints
from windup.hal.observation import Observation
from windup.hal.torque_state import TorqueState


def guarded(stop: StopPolicy = "limp", crouch: float | None = None) -> GuardedBackend:
    pose = None if crouch is None else np.full(N, crouch)
    return GuardedBackend(FakeBackend(), SafetyLimits.of(JOINTS), stop, pose)


def fake(guard: GuardedBackend) -> FakeBackend:
    assert isinstance(guard.backend, FakeBackend)
    return guard.backend


def hold(name: str = "position", joint: int = 0, value: float = 0.5) -> JointCommand:
    """Return a command within the limits, but for one value of one joint."""
    block = JointCommand.hold(JOINTS, np.full(N, 0.5)).block.copy()
    block[FIELDS.index(name), joint] = value
    return JointCommand(block)


def test_a_command_within_the_limits_passes_as_it_is() -> None:
    guard = guarded()
    command = hold()
    np.testing.assert_array_equal(guard.write(command).block, command.block)
    assert guard.clamps == dict.fromkeys(FIELDS, 0)


@pytest.mark.parametrize(
    ("name", "joint", "value", "got"),
    [
        ("position", 1, 1.5, 1.0),
        ("position", 2, -0.5, 0.0),
        ("velocity", 0, 9.0, 5.0),
        ("velocity", 0, -9.0, -5.0),
        ("torque", 3, 5.0, 4.0),
        ("stiffness", 0, 1000.0, 80.0),
        ("stiffness", 0, -1.0, 0.0),
        ("damping", 4, 100.0, 4.0),
    ],
)
def test_every_clamp_has_a_name_and_a_counter(
    name: str, joint: int, value: float, got: float
) -> None:
    guard = guarded()
    row = FIELDS.index(name)
    command = hold(name, joint, value)
    for _ in range(3):
        real = guard.write(command)
    assert real.block[row, joint] == got
    assert guard.clamps == {**dict.fromkeys(FIELDS, 0), name: 3}
    np.testing.assert_array_equal(guard.clamped_joints, 3.0 * (np.arange(N) == joint))
    assert command.block[row, joint] == value, "the caller's own command is left alone"
    assert guard.clamp_bits is not None
    assert guard.clamp_bits.tolist() == [(1 << row) * (k == joint) for k in range(N)]
    guard.write(hold())
    assert guard.clamp_bits is None


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_what_is_no_number_is_refused_and_not_sent(value: float) -> None:
    guard = guarded()
    command = hold("torque", 4, value)
    with pytest.raises(UnsafeCommandError) as error:
        guard.write(command)
    assert (
        str(error.value)
        == f"the controller commanded torque {value} for joint 'r_knee'; give finite values"
    )
    assert fake(guard).written == []


def test_infinity_is_refused_at_a_joint_without_a_limit_too() -> None:
    free = Joints((Joint("hip", -1.0, 1.0, stiffness=1.0, damping=1.0),))
    backend = FakeBackend(joints=free)
    guard = GuardedBackend(backend, SafetyLimits.of(free))
    command = JointCommand.of(free, position=0.0, torque=np.inf)
    with pytest.raises(
        UnsafeCommandError, match="commanded torque inf for joint 'hip'; give finite values"
    ):
        guard.write(command)
    assert backend.written == []


@pytest.mark.parametrize("shape", [(5, N + 1), (4, N), (N,), (1, 5, N)])
def test_a_command_of_another_shape_is_refused(shape: tuple[int, ...]) -> None:
    guard = guarded()
    with pytest.raises(UnsafeCommandError) as error:
        guard.write(JointCommand(np.zeros(shape)))
    assert str(error.value) == (
        f"a command of shape {shape} for {N} joints; its shape has to be {(5, N)}"
    )
    assert fake(guard).written == []


def test_a_joint_that_has_not_answered_for_too_long_is_named() -> None:
    guard = guarded()
    fake(guard).age[3] = 0.25
    guard.read()
    fake(guard).age[3] = 0.3
    with pytest.raises(StaleStateError) as error:
        guard.read()
    assert str(error.value) == (
        "joint 'r_hip' has not answered for 0.30 s (limit 0.25 s); check its cable and power, "
        "then run `windup health`"
    )


def test_stop_hold_keeps_the_pose_last_read_with_the_torque_on() -> None:
    guard = guarded("hold")
    fake(guard).position = np.full(N, 0.7)
    guard.read()
    assert guard.stop().all_on
    last = fake(guard).written[-1]
    np.testing.assert_array_equal(last.position, np.full(N, 0.7))
    np.testing.assert_array_equal(last.stiffness, JOINTS.stiffness)
    assert fake(guard).powered


def test_stop_hold_does_not_ask_for_a_pose_outside_the_limits() -> None:
    guard = guarded("hold")
    fake(guard).position = np.full(N, 3.0)
    guard.stop()
    np.testing.assert_array_equal(fake(guard).written[-1].position, JOINTS.upper)


def test_stop_limp_switches_the_torque_off_at_once() -> None:
    guard = guarded("limp")
    assert guard.stop().all_off
    assert not fake(guard).powered
    assert fake(guard).written == []
    assert fake(guard).clock.now() == 0.0


def test_stop_crouch_glides_there_and_then_goes_limp() -> None:
    guard = guarded("crouch", crouch=0.8)
    guard.read()
    assert guard.stop().all_off
    way = np.array([command.position[0] for command in fake(guard).written])
    assert way[0] == 0.0
    assert way[-1] == pytest.approx(0.8, abs=1e-3)
    assert (np.diff(way) > 0.0).all()
    assert np.diff(way).max() < 0.01, "no jump"
    assert fake(guard).clock.now() == pytest.approx(1.5, abs=0.01)
    assert not fake(guard).powered


def test_a_stop_may_be_told_another_policy_than_the_robots_own() -> None:
    guard = guarded("hold")
    assert guard.stop("limp").all_off
    assert not fake(guard).powered


def test_stop_names_the_joints_whose_torque_stays_on() -> None:
    guard = guarded("limp")
    fake(guard).stuck[[1, 4]] = True
    with pytest.raises(HardwareError) as error:
        guard.stop()
    assert str(error.value) == "torque is still on at l_hip, r_knee; cut the servo power"


def test_torque_that_cannot_be_read_back_is_called_unknown_not_on() -> None:
    guard = guarded("limp")
    fake(guard).silent[:] = True
    with pytest.raises(TorqueUnknownError, match="torque is unknown at all joints: no answer"):
        guard.stop()


# Health


@dataclass
class Servos(FakeBackend):
    """Three joints with servos, whose temperature can be set."""

    joints: Joints = servo_state.JOINTS
    temperature: float = 30.0
    readings: int = 0
    misread: bool = False

    def __post_init__(self) -> None:
        self.position = np.zeros(len(self.joints))
        self.silent = self.stuck = np.zeros(len(self.joints), dtype=bool)

    def collect(self) -> Observation:
        self.readings += 1
        wrong = self.misread and self.readings == 1
        return servo_state.seen(self.clock.now(), temperature=250.0 if wrong else self.temperature)

    def read_health(self) -> None: ...

    def set_torque(self, on: bool) -> TorqueState:
        self.powered = on
        return TorqueState.known(np.full(len(self.joints), on))


def watched(**servos: Any) -> tuple[GuardedBackend, Servos]:
    backend = Servos(powered=False, **servos)
    limits = SafetyLimits.of(backend.joints)
    return GuardedBackend(backend, limits, watch=servo_state.watch()), backend


def pass_time(guard: GuardedBackend, seconds: float) -> None:
    for _ in range(round(seconds / 0.01)):
        guard.clock.wait_until(guard.clock.now() + 0.01)
        guard.read()


def test_a_joint_that_is_driven_and_unwell_raises_out_of_the_guard() -> None:
    guard, servos = watched()
    guard.set_torque(True)
    guard.write(servo_state.goal(0.0))
    pass_time(guard, 2.0)
    servos.temperature = 75.0
    with pytest.raises(UnhealthyError, match=r"knee is at 75 degrees C \(stop at 72\)"):
        pass_time(guard, 2.0)
    guard.stop()
    assert not servos.powered
    pass_time(guard, 2.0)  # who is limp may be looked at, however hot


def test_torque_does_not_come_on_at_an_unwell_joint() -> None:
    guard, servos = watched(temperature=75.0)
    with pytest.raises(UnhealthyError) as refused:
        guard.set_torque(True)
    assert str(refused.value) == (
        "knee is at 75 degrees C (stop at 72): nothing has moved; "
        "let it cool; a pose with less load helps"
    )
    assert refused.value.exit_status == 3
    assert not servos.powered
    servos.temperature = 70.0
    assert guard.set_torque(True).all_on


def test_one_wrong_byte_refuses_nobody() -> None:
    guard, _ = watched(misread=True)
    assert guard.set_torque(True).all_on


def test_an_answer_lost_after_a_long_arming_is_no_reason_to_stop() -> None:
    guard, servos = watched()
    silent = iter([True, True, False])

    def collect() -> Observation:
        servos.clock.time += 0.2
        late = 0.4 if next(silent, False) else 0.0
        seen = servo_state.seen(servos.clock.now())
        return replace(seen, joints=replace(seen.joints, age=np.array([0.0, late, 0.0])))

    guard.check_before_arming()
    servos.collect = collect  # type: ignore[method-assign]
    guard.watch = None
    assert guard.set_torque(True).all_on
    assert servos.read().joints.age.max() == 0.0
    assert next(silent, None) is None, "they have been read"


def test_arming_again_asks_for_health_too() -> None:
    guard, servos = watched(temperature=75.0)
    with pytest.raises(UnhealthyError):
        guard.rearm()
    assert not servos.powered
