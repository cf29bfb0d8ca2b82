import mujoco
import numpy as np
import pytest

from windup import Robot
from windup.robots import RobotDescription, load_robot
from windup.tools.assembly.walk_options import WalkOptions

DENSITY = 1000.0  # kg/m3


@pytest.fixture(scope="module")
def bird() -> RobotDescription:
    return load_robot("robobird")


def rods(model: mujoco.MjModel, body: int) -> tuple[float, np.ndarray, np.ndarray]:
    """Return mass, centre of mass (3,) and inertia (3, 3) of a body's segments as solid rods."""
    cylinders = (model.geom_bodyid == body) & (model.geom_type == mujoco.mjtGeom.mjGEOM_CYLINDER)
    ids = np.flatnonzero(cylinders)
    radius, half = model.geom_size[ids, 0], model.geom_size[ids, 1]
    mass = DENSITY * np.pi * radius**2 * 2.0 * half
    com = mass @ model.geom_pos[ids] / mass.sum()
    whole = np.zeros((3, 3))
    for i, m, r, h in zip(ids, mass, radius, half, strict=True):
        across = m * (3.0 * r**2 + 4.0 * h**2) / 12.0
        turn, arm = matrix(model.geom_quat[i]), model.geom_pos[i] - com
        whole += turn @ np.diag([across, across, 0.5 * m * r**2]) @ turn.T
        whole += m * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return mass.sum(), com, whole


def matrix(quat: np.ndarray) -> np.ndarray:
    """Return the rotation (3, 3) of a quaternion (4,) wxyz."""
    flat = np.empty(9)
    mujoco.mju_quat2Mat(flat, quat)
    return flat.reshape(3, 3)


def inertia(model: mujoco.MjModel, body: int) -> np.ndarray:
    """Return the inertia (3, 3) of a body about its own centre of mass, in its own axes."""
    turn = matrix(model.body_iquat[body])
    return turn @ np.diag(model.body_inertia[body]) @ turn.T


def test_inertias_are_those_of_its_segments(bird: RobotDescription) -> None:
    model = bird.spec().compile()
    assert model.body_mass.sum() == pytest.approx(10.748, abs=1e-3)
    for body in range(1, model.nbody):
        mass, com, whole = rods(model, body)
        assert model.body_mass[body] == pytest.approx(mass, rel=1e-4)
        np.testing.assert_allclose(model.body_ipos[body], com, atol=1e-5)
        np.testing.assert_allclose(inertia(model, body), whole, atol=1e-5)


def test_the_ankle_damps_its_foot_critically_in_roll(bird: RobotDescription) -> None:
    model = bird.spec().compile()
    foot = model.body("l_foot").id
    arm = model.body_ipos[foot]
    about_roll = inertia(model, foot)[0, 0] + model.body_mass[foot] * (arm[1] ** 2 + arm[2] ** 2)
    ankle = bird.joints.index("l_ankle_roll")
    stiffness, damping = bird.joints.stiffness[ankle], bird.joints.damping[ankle]
    assert damping / (2.0 * np.sqrt(stiffness * about_roll)) == pytest.approx(1.0, abs=0.01)


def test_it_has_the_thesis_15_hinges(bird: RobotDescription) -> None:
    leg = ("hip_roll", "hip_pitch", "knee1", "knee2", "knee3", "ankle_pitch", "ankle_roll")
    legs = [f"{side}_{joint}" for side in "lr" for joint in leg]
    assert bird.joints.names == ("neck", *legs)
    gains = set(zip(bird.joints.stiffness, bird.joints.damping, strict=True))
    assert gains == {(1000.0, 33.0), (100.0, 1.5)}


@pytest.mark.parametrize(
    ("site", "place"),
    [
        ("l_toe_in", (0.76, 0.11, -1.04)),
        ("l_heel_out", (0.38, 0.39, -1.04)),
        ("r_toe_out", (0.76, -0.39, -1.04)),
        ("r_heel_in", (0.38, -0.11, -1.04)),
    ],
)
def test_monitor_points_are_where_the_thesis_puts_them(
    bird: RobotDescription, site: str, place: tuple[float, float, float]
) -> None:
    model = bird.spec().compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    offset = data.site(site).xpos - data.body("body").xpos
    np.testing.assert_allclose(offset, place, atol=1e-9)


@pytest.mark.parametrize("side", ["l", "r"])
def test_rolling_a_hip_moves_the_leg_outward(bird: RobotDescription, side: str) -> None:
    model = bird.spec().compile()
    data = mujoco.MjData(model)
    data.joint(f"{side}_hip_roll").qpos = 0.2
    mujoco.mj_kinematics(model, data)
    assert abs(data.body(f"{side}_foot").xpos[1]) > 0.4


def test_it_stands_on_all_eight_points() -> None:
    with Robot.open("robobird") as robot:
        robot.stand(2.0)
        forces = [robot.twin.data.sensor(n).data[0] for n in robot.description.contacts.names]
        assert min(forces) > 5.0
        assert sum(forces) == pytest.approx(10.748 * 9.81, rel=1e-2)
        assert robot.twin.up[2] > 0.99


def test_it_runs_with_a_flight_in_every_step() -> None:
    with Robot.open("robobird", noise=0.2) as robot:
        threshold = robot.description.contacts.threshold
        touched: list[np.ndarray] = []
        robot.watch.append(lambda seen: touched.append(seen.contacts.reshape(2, 4).max(axis=1)))
        report = robot.walk(steps=20, options=WalkOptions(gait="run"))
        assert report.done
    down = np.array(touched) > threshold
    flights = np.count_nonzero(np.diff((~down.any(axis=1)).astype(int)) == 1)
    assert flights >= 19  # the last one may not have ended
    assert down.all(axis=1).mean() < 0.01


def test_it_hops_on_both_feet() -> None:
    with Robot.open("robobird", noise=0.2) as robot:
        result = robot.walk(steps=12, options=WalkOptions(gait="hop")).result()
    assert result["reason"] == "done"
    assert result["flights"] >= 11
    assert result["flight_time_s"] > 0.3 * result["sim_time_s"]
    assert abs(result["touches"].count("l") - result["touches"].count("r")) <= 1


def test_it_skips_twice_on_one_foot_and_twice_on_the_other() -> None:
    with Robot.open("robobird", noise=0.2, seed=4) as robot:
        result = robot.walk(steps=20, options=WalkOptions(gait="skip")).result()
    assert result["reason"] == "done"
    assert "rrllrrll" in result["touches"]
    assert result["skips"] > 0.8
    assert result["flights"] >= 16
