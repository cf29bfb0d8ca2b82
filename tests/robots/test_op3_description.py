import mujoco
import numpy as np
import pytest

from windup.hal.errors import UsageError
from windup.robots import RobotDescription, load_robot


@pytest.fixture(scope="module")
def op3() -> RobotDescription:
    return load_robot("op3")


def posed(robot: RobotDescription, pose: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return the robot in a pose, its soles on the floor, with a position actuator a joint."""
    spec = robot.spec()
    for joint in robot.joints.joints:
        actuator = spec.add_actuator(name=joint.name, target=joint.name)
        actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
        actuator.set_to_position(kp=joint.stiffness, kv=joint.damping)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[7:] = data.ctrl[:] = robot.poses[pose]
    mujoco.mj_kinematics(model, data)
    data.qpos[2] -= min(data.site(foot.site).xpos[2] for foot in robot.feet)
    return model, data


def touch(robot: RobotDescription, data: mujoco.MjData) -> list[float]:
    return [data.sensor(name).data[0] for name in robot.contacts.names]


def test_it_weighs_what_its_source_weighs(op3: RobotDescription) -> None:
    model = op3.spec().compile()
    assert model.body_mass.sum() == pytest.approx(3.14747, abs=1e-6)
    assert (model.nq, model.nv, model.nu) == (27, 26, 0)


def test_joints_are_in_mjcf_order_whatever_the_toml_says(op3: RobotDescription) -> None:
    model = op3.spec().compile()
    assert op3.joints.names == tuple(model.joint(j).name for j in range(1, model.njnt))
    assert op3.joints.names[:2] == ("head_pan", "head_tilt")


def test_zero_pose_puts_feet_and_hands_where_the_links_add_up(op3: RobotDescription) -> None:
    model = op3.spec().compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    base = data.body("body_link").xpos
    np.testing.assert_allclose(data.body("l_ank_roll_link").xpos - base, [-0.024, 0.035, -0.24865])
    np.testing.assert_allclose(data.site("left_foot").xpos, [0.0, 0.0477, 0.0], atol=1e-9)
    np.testing.assert_allclose(data.site("right_hand").xpos - base, [-0.002, -0.3189, 0.1009])


@pytest.mark.parametrize("pose", ["stand", "bent_knees", "crouch"])
def test_it_stands_on_all_eight_sensors(op3: RobotDescription, pose: str) -> None:
    model, data = posed(op3, pose)
    mujoco.mj_step(model, data, 1000)
    forces = touch(op3, data)
    assert min(forces) > 0.3
    assert sum(forces) == pytest.approx(3.14747 * 9.81, rel=1e-3)
    assert np.degrees(np.arccos(data.body(op3.torso).xmat[8])) < 6.0
    assert np.abs(data.qvel).max() < 0.01


def test_a_fallen_robot_lies_on_its_body_and_not_in_the_floor(op3: RobotDescription) -> None:
    model, data = posed(op3, "stand")
    data.qpos[3:7] = [0.7071, 0.0, 0.7071, 0.0]  # on its face
    data.qpos[2] = 0.2
    mujoco.mj_step(model, data, 1500)
    assert 0.0 < data.body("body_link").xpos[2] < op3.fall.height
    assert data.body("head_tilt_link").xpos[2] > 0.0
    touched = {model.geom(g).name for pair in data.contact.geom for g in pair}
    assert touched & {"torso", "head", "l_hand", "r_hand"}


def test_legs_meet_the_floor_and_not_each_other(op3: RobotDescription) -> None:
    model, data = posed(op3, "stand")
    data.joint("l_hip_roll").qpos = 0.5
    data.joint("r_hip_roll").qpos = -0.5
    mujoco.mj_forward(model, data)
    assert all(0 in pair for pair in data.contact.geom)


def test_limits_come_from_the_servos_data_sheet(op3: RobotDescription) -> None:
    np.testing.assert_allclose(op3.joints.torque, 4.1)
    np.testing.assert_allclose(op3.joints.velocity, 4.817, atol=1e-3)


def test_default_gains_are_what_register_p_800_means(op3: RobotDescription) -> None:
    for mount, stiffness, damping in zip(
        op3.servos, op3.joints.stiffness, op3.joints.damping, strict=True
    ):
        assert mount is not None
        assert mount.model.p_register(stiffness, op3.drive.supply) == pytest.approx(800, abs=0.1)
        assert mount.model.damping(op3.drive.supply) == pytest.approx(damping, abs=1e-4)


def test_servo_ids_follow_the_robots_own_bus_map(op3: RobotDescription) -> None:
    ids = {
        name: mount.id for name, mount in zip(op3.joints.names, op3.servos, strict=True) if mount
    }
    assert (ids["r_sho_pitch"], ids["l_knee"], ids["head_tilt"]) == (1, 14, 20)
    assert sorted(ids.values()) == list(range(1, 21))
    assert {(m.bus, m.sign, m.zero, m.ratio) for m in op3.servos if m} == {("body", 1, 2048, 1.0)}


def test_crouching_is_not_falling(op3: RobotDescription) -> None:
    model, data = posed(op3, "crouch")
    mujoco.mj_step(model, data, 1000)
    assert data.body(op3.base).xpos[2] > op3.fall.height


def test_a_rate_must_be_a_whole_number_of_physics_steps(op3: RobotDescription) -> None:
    assert op3.physics_steps() == 2
    assert op3.physics_steps(125.0) == 4
    with pytest.raises(UsageError, match="300 Hz is not a whole number of physics steps of 2 ms"):
        op3.physics_steps(300.0)


def test_a_spec_belongs_to_its_caller(op3: RobotDescription) -> None:
    op3.spec().worldbody.add_body(name="box")
    assert op3.spec().body("box") is None
