from math import pi

import numpy as np
import pytest

from windup.hal.command import JointCommand, joint_torque, shifted_goal
from windup.hal.joints import Array
from windup.robots import RobotDescription
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.rollouts import RolloutPredictor
from windup.sim_twin.servo.servo_motor import KD, KP, VMAX, ServoDrive
from windup.sim_twin.twin import Twin

COUNT = 2.0 * pi / 4096


def hold(robot: RobotDescription, position: Array | None = None) -> JointCommand:
    return JointCommand.hold(robot.joints, robot.stance if position is None else position)


def drive(robot: RobotDescription, supply: float = 12.0) -> tuple[ServoDrive, Twin]:
    twin = Twin(robot, supply=supply)
    return ServoDrive(twin.model, robot, twin.supply), twin


def test_goals_are_rounded_to_encoder_counts(op3: RobotDescription) -> None:
    servos, twin = drive(op3)
    real = servos.write(hold(op3), twin.data.ctrl)
    np.testing.assert_allclose(real.position / COUNT, np.rint(op3.stance / COUNT), atol=1e-9)
    np.testing.assert_array_equal(twin.data.ctrl, real.position)
    assert np.abs(real.position - op3.stance).max() <= COUNT / 2


def test_stiffness_is_rounded_to_p_registers_and_damping_is_the_motors_own(
    op3: RobotDescription,
) -> None:
    servos, twin = drive(op3)
    command = JointCommand.of(op3.joints, position=op3.stance, stiffness=10.0, damping=0.0)
    real = servos.write(command, twin.data.ctrl)
    servo = op3.servos[0]
    assert servo is not None
    unit = servo.model.stiffness(1.0, 12.0)
    np.testing.assert_allclose(real.stiffness, np.rint(10.0 / unit) * unit)
    assert np.abs(real.stiffness - 10.0).max() <= unit / 2
    np.testing.assert_allclose(real.damping, servo.model.damping(12.0))
    np.testing.assert_allclose(twin.model.actuator_gainprm[:, KP], real.stiffness)


def test_feed_forward_becomes_a_shifted_goal(op3: RobotDescription) -> None:
    servos, twin = drive(op3)
    command = JointCommand.of(op3.joints, position=op3.stance, velocity=0.5, torque=-0.3)
    real = servos.write(command, twin.data.ctrl)
    assert np.abs(real.position - shifted_goal(command)).max() <= COUNT / 2
    assert np.abs(real.position - command.position).max() > 3 * COUNT
    assert not real.velocity.any()
    assert not real.torque.any()


def test_gains_are_sent_only_when_they_change(op3: RobotDescription) -> None:
    servos, twin = drive(op3)
    for position in (0.0, 0.1, 0.2):
        servos.write(hold(op3, op3.stance + position), twin.data.ctrl)
    assert servos.sent_gains == 1
    softer = op3.joints.stiffness * np.where(np.arange(len(op3.joints)) == 4, 0.5, 1.0)
    command = JointCommand.of(op3.joints, position=op3.stance, stiffness=softer)
    servos.write(command, twin.data.ctrl)
    assert servos.sent_gains == 2


@pytest.mark.parametrize("supply", [10.0, 11.1, 14.8])
def test_the_supply_changes_what_a_p_register_means_and_the_voltage_limit(
    op3: RobotDescription, supply: float
) -> None:
    servos, twin = drive(op3, supply)
    real = servos.write(hold(op3), twin.data.ctrl)
    servo = op3.servos[0]
    assert servo is not None
    # P 800 was asked for, by a driver that believes in 12 V.
    np.testing.assert_allclose(real.stiffness, servo.model.stiffness(800, supply))
    np.testing.assert_allclose(twin.model.actuator_gainprm[:, KP], real.stiffness)
    np.testing.assert_allclose(twin.model.actuator_gainprm[:, VMAX], supply)
    np.testing.assert_allclose(real.damping, servo.model.damping(supply))
    observed = TwinBackend(twin).read()
    np.testing.assert_array_equal(observed.joints.voltage, np.full(len(op3.joints), supply))


@pytest.mark.parametrize("supply", [10.0, 12.0, 14.8])
def test_a_fresh_twin_has_the_stiffness_that_the_first_command_will_set(
    op3: RobotDescription, supply: float
) -> None:
    servos, twin = drive(op3, supply)
    fresh = twin.model.actuator_gainprm[:, KP].copy()
    servos.write(hold(op3), twin.data.ctrl)
    np.testing.assert_allclose(fresh, twin.model.actuator_gainprm[:, KP], rtol=1e-4)


@pytest.mark.parametrize("supply", [10.0, 12.0, 14.8])
def test_rollouts_are_as_stiff_as_the_twin_at_any_supply(
    op3: RobotDescription, supply: float
) -> None:
    servos, twin = drive(op3, supply)
    servos.write(hold(op3), twin.data.ctrl)
    rollouts = RolloutPredictor(op3, supply=supply).model
    for place in (KP, KD, VMAX):
        np.testing.assert_allclose(
            rollouts.actuator_gainprm[:, place], twin.model.actuator_gainprm[:, place], rtol=1e-4
        )


def test_ideal_joints_do_exactly_what_they_are_told(human: RobotDescription) -> None:
    backend = TwinBackend(Twin(human))
    shape = hold(human).block.shape
    command = JointCommand(np.random.default_rng(0).uniform(0.1, 1.0, shape))
    np.testing.assert_array_equal(backend.write(command).block, command.block)


def test_the_humans_torque_law_holds_at_every_physics_step(human: RobotDescription) -> None:
    twin = Twin(human)
    backend = TwinBackend(twin)
    rng = np.random.default_rng(1)
    state = {"q": twin.data.qpos[7:].copy(), "dq": twin.data.qvel[6:].copy()}
    worst: list[float] = []
    command = hold(human)

    def check() -> None:
        """Compare the torque of this step with the law at the state where it began."""
        free = np.full(len(human.joints), np.inf)
        wanted = joint_torque(command, state["q"], state["dq"], free)
        worst.append(float(np.abs(twin.data.qfrc_actuator[6:] - wanted).max()))
        state["q"], state["dq"] = twin.data.qpos[7:].copy(), twin.data.qvel[6:].copy()

    twin.on_step = check
    for _ in range(20):
        n, joints = len(human.joints), human.joints
        command = JointCommand.of(
            joints,
            position=human.stance + rng.normal(0.0, 0.1, n),
            velocity=rng.normal(0.0, 0.5, n),
            torque=rng.normal(0.0, 5.0, n),
            stiffness=joints.stiffness * rng.uniform(0.5, 1.0),
            damping=joints.damping * rng.uniform(0.5, 1.0),
        )
        backend.write(command)
        twin.step(8)
    assert len(worst) == 160
    assert max(worst) < 1e-9
    assert np.abs(twin.data.qfrc_actuator[6:]).max() > 10.0, "they worked hard"
