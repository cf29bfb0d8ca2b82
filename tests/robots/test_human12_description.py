import mujoco
import numpy as np
import pytest

from windup import Robot
from windup.robots import RobotDescription, load_robot
from windup.tools.assembly.walk_options import WalkOptions

TORSO = (
    "lower_torso",
    "upper_torso",
    "l_upper_arm",
    "l_lower_arm",
    "r_upper_arm",
    "r_lower_arm",
)


@pytest.fixture(scope="module")
def human12() -> RobotDescription:
    return load_robot("human12")


def world(robot: RobotDescription) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = robot.spec().compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def lump(
    model: mujoco.MjModel, data: mujoco.MjData, bodies: tuple[str, ...]
) -> tuple[float, np.ndarray, np.ndarray]:
    """Return mass, centre of mass (3,) and inertia (3, 3) of `bodies` together, in the world."""
    ids = [model.body(name).id for name in bodies]
    mass = model.body_mass[ids]
    com = mass @ data.xipos[ids] / mass.sum()
    inertia = np.zeros((3, 3))
    for i in ids:
        turn, arm = data.ximat[i].reshape(3, 3), data.xipos[i] - com
        inertia += turn @ np.diag(model.body_inertia[i]) @ turn.T
        inertia += model.body_mass[i] * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return mass.sum(), com, inertia


def test_it_has_12_hinges_and_the_weight_of_the_human(human12: RobotDescription) -> None:
    model, _ = world(human12)
    assert model.body_mass.sum() == pytest.approx(88.29, abs=0.005)
    leg = ("hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")
    legs = [f"{side}_{joint}" for side in "lr" for joint in leg]
    assert human12.joints.names == ("waist", "neck", *legs)


def test_its_torso_is_the_humans_with_the_arms(human12: RobotDescription) -> None:
    mass, com, inertia = lump(*world(load_robot("human")), TORSO)
    ours = lump(*world(human12), ("torso",))
    assert ours[0] == pytest.approx(mass)
    np.testing.assert_allclose(ours[1], com, atol=1e-7)
    np.testing.assert_allclose(ours[2], inertia, atol=1e-7)


def test_everything_else_is_the_humans(human12: RobotDescription) -> None:
    (model, data), (human, there) = world(human12), world(load_robot("human"))
    for i in range(1, model.nbody):
        name = model.body(i).name
        if name == "torso":
            continue
        np.testing.assert_allclose(data.body(name).xpos, there.body(name).xpos, atol=1e-9)
        np.testing.assert_array_equal(model.body_inertia[i], human.body(name).inertia)


def test_its_gains_are_the_humans(human12: RobotDescription) -> None:
    human = load_robot("human")
    rows = [human.joints.index(name) for name in human12.joints.names]
    np.testing.assert_array_equal(human12.joints.stiffness, human.joints.stiffness[rows])
    np.testing.assert_array_equal(human12.joints.damping, human.joints.damping[rows])


@pytest.mark.parametrize("torso_servo", [True, False])
def test_it_walks(torso_servo: bool) -> None:
    with Robot.open("human12", noise=0.2) as robot:
        options = WalkOptions(torso_servo=torso_servo)
        assert robot.walk(steps=20, options=options).done
