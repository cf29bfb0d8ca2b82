import mujoco
import numpy as np
import pytest

from windup.robots import RobotDescription, load_robot


@pytest.fixture(scope="module")
def human() -> RobotDescription:
    return load_robot("human")


@pytest.fixture
def world(human: RobotDescription) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = human.spec().compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def test_it_weighs_what_the_thesis_says(
    world: tuple[mujoco.MjModel, mujoco.MjData], human: RobotDescription
) -> None:
    model, _ = world
    assert model.body_mass.sum() == pytest.approx(88.29, abs=0.005)
    assert (model.nbody, len(human.joints), model.nv) == (15, 19, 25)


def test_hips_turn_roll_then_pitch_then_yaw(human: RobotDescription) -> None:
    first = human.joints.index("l_hip_roll")
    assert human.joints.names[first : first + 3] == ("l_hip_roll", "l_hip_pitch", "l_hip_yaw")


@pytest.mark.parametrize(
    ("body", "place"),
    [
        ("pelvis", (0.0, 0.0, 0.95)),
        ("lower_torso", (0.0, 0.0, 1.0202)),
        ("head", (-0.0478, 0.0, 1.5052)),
        ("l_upper_leg", (-0.00478, 0.0932, 0.9629)),
        ("r_foot", (-0.03348, -0.0837, 0.09164)),
        ("l_lower_arm", (-0.0287, 0.2102, 1.1491)),
    ],
)
def test_hinges_are_where_the_thesis_puts_them(
    world: tuple[mujoco.MjModel, mujoco.MjData], body: str, place: tuple[float, float, float]
) -> None:
    np.testing.assert_allclose(world[1].body(body).xpos, place, atol=1e-9)


def test_inertias_are_turned_with_the_axes(
    world: tuple[mujoco.MjModel, mujoco.MjData],
) -> None:
    model, data = world
    body = model.body("l_foot").id
    turn = data.ximat[body].reshape(3, 3)
    inertia = turn @ np.diag(model.body_inertia[body]) @ turn.T
    np.testing.assert_allclose(inertia, np.diag([0.0018, 0.0075, 0.0070]), atol=1e-12)


@pytest.mark.parametrize(
    ("joint", "site", "axis", "sign"),
    [
        ("l_hip_pitch", "left_foot", 0, -1),  # + swings the leg back
        ("l_knee", "left_foot", 0, -1),  # + bends it
        ("l_ankle_pitch", "l_ball_in", 2, -1),  # + points the toes down
        ("l_hip_yaw", "l_ball_in", 1, +1),  # + turns the toes out
        ("r_hip_yaw", "r_ball_in", 1, +1),  # + turns the toes in
        ("waist", "head_top", 0, +1),  # + leans forward
    ],
)
def test_signs_of_the_joints(
    human: RobotDescription, joint: str, site: str, axis: int, sign: int
) -> None:
    spec = human.spec()
    spec.body("head").add_site(name="head_top", pos=[0, 0, 0.3])
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    before = data.site(site).xpos[axis]
    data.joint(joint).qpos = 0.2
    mujoco.mj_kinematics(model, data)
    assert np.sign(data.site(site).xpos[axis] - before) == sign


def test_standing_still_all_ten_points_touch_and_nothing_else(
    world: tuple[mujoco.MjModel, mujoco.MjData], human: RobotDescription
) -> None:
    model, data = world
    for _ in range(20):  # long enough to load the contacts, too short to fall
        data.qvel[6:] = 0.0
        mujoco.mj_step(model, data)
    assert min(data.sensor(name).data[0] for name in human.contacts.names) > 1.0
    touched = {model.geom(g).name for pair in data.contact.geom for g in pair}
    assert touched == {"floor", *human.contacts.names}


def test_gains_are_numbered_by_the_bone_that_the_hinge_moves(human: RobotDescription) -> None:
    gains = zip(human.joints.stiffness, human.joints.damping, strict=True)
    table = dict(zip(human.joints.names, gains, strict=True))
    assert table["waist"] == (2000.0, 100.0)
    assert table["neck"] == (100.0, 10.0)
    assert table["r_hip_roll"] == (900.0, 30.0)
    assert table["l_ankle_roll"] == (170.0, 17.0)
    assert table["l_elbow"] == (50.0, 5.0)


def test_its_joints_are_ideal(human: RobotDescription) -> None:
    assert human.drive.kind == "torque"
    assert set(human.servos) == {None}
    assert np.isinf(human.joints.torque).all()


def test_it_starts_with_the_right_leg_in_the_air(human: RobotDescription) -> None:
    start = dict(zip(human.joints.names, np.degrees(human.poses["start"]), strict=True))
    bent = {name: round(angle, 3) for name, angle in start.items() if angle}
    assert bent == {"r_hip_roll": -5.1, "r_hip_pitch": -20.0, "r_knee": 50.0}
