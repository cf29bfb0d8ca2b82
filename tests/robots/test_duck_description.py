import mujoco
import numpy as np
import pytest

from windup import Robot
from windup.control.motions.play import PoseHolder
from windup.robots import RobotDescription, load_robot
from windup.tools.assembly.walk_options import WalkOptions

LEGS = ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle")
HEAD = ("neck_pitch", "head_pitch", "head_yaw", "head_roll")


@pytest.fixture(scope="module")
def duck() -> RobotDescription:
    return load_robot("duck")


def test_it_weighs_what_its_source_weighs(duck: RobotDescription) -> None:
    model = duck.spec().compile()
    assert model.body_mass.sum() == pytest.approx(2.107141, abs=1e-6)
    assert (model.nq, model.nv, model.nu) == (21, 20, 0)


def test_joints_are_in_mjcf_order_whatever_the_toml_says(duck: RobotDescription) -> None:
    model = duck.spec().compile()
    assert duck.joints.names == tuple(model.joint(j).name for j in range(1, model.njnt))
    left, right = (tuple(f"{side}_{joint}" for joint in LEGS) for side in ("left", "right"))
    assert duck.joints.names == (*left, *HEAD, *right)


@pytest.mark.parametrize(
    ("body", "place"),
    [
        ("left_roll_to_pitch_assembly", (5e-5, 0.035, -7.4e-5)),
        ("foot_assembly", (-0.0350616, 0.10895, -0.1573742)),
        ("foot_assembly_2", (-0.0350599, -0.07225, -0.1573742)),
        ("head_assembly", (0.04195, 0.0001, 0.1938509)),
    ],
)
def test_hinges_are_where_the_links_add_up(
    duck: RobotDescription, body: str, place: tuple[float, float, float]
) -> None:
    model = duck.spec().compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    offset = data.body(body).xpos - data.body(duck.base).xpos
    np.testing.assert_allclose(offset, place, atol=1e-4)


@pytest.mark.parametrize(
    ("joint", "axis", "sign"),
    [
        ("left_hip_pitch", 0, +1),  # + swings the leg forward
        ("right_hip_pitch", 0, -1),  # + swings it back
        ("left_hip_roll", 1, -1),  # + moves the foot inward
        ("right_hip_roll", 1, -1),  # + moves it outward
        ("left_knee", 0, +1),  # + brings the foot forward, below a thigh that goes back
        ("right_knee", 0, +1),
    ],
)
def test_signs_of_the_legs(duck: RobotDescription, joint: str, axis: int, sign: int) -> None:
    model = duck.spec().compile()
    data = mujoco.MjData(model)
    site = data.site("left_foot" if joint.startswith("left") else "right_foot")
    mujoco.mj_kinematics(model, data)
    before = site.xpos[axis]
    data.joint(joint).qpos = 0.2
    mujoco.mj_kinematics(model, data)
    assert np.sign(site.xpos[axis] - before) == sign


def test_servo_ids_follow_the_robots_own_bus_map(duck: RobotDescription) -> None:
    names = duck.joints.names
    ids = {name: mount.id for name, mount in zip(names, duck.servos, strict=True) if mount}
    legs = [[ids[f"{side}_{joint}"] for joint in LEGS] for side in ("left", "right")]
    assert legs == [[20, 21, 22, 23, 24], [10, 11, 12, 13, 14]]
    assert [ids[joint] for joint in HEAD] == [30, 31, 32, 33]
    assert {(m.bus, m.sign, m.zero, m.ratio) for m in duck.servos if m} == {("body", 1, 2048, 1.0)}
    assert [(bus.protocol, bus.baud) for bus in duck.buses] == [("feetech", 1_000_000)]


def test_gains_are_the_registers_that_the_robot_runs(duck: RobotDescription) -> None:
    for name, mount, stiffness, damping in zip(
        duck.joints.names, duck.servos, duck.joints.stiffness, duck.joints.damping, strict=True
    ):
        assert mount is not None
        register = 8 if name in HEAD else 30
        supply = duck.drive.supply
        assert mount.model.p_register(stiffness, supply) == pytest.approx(register, abs=0.01)
        assert mount.model.damping(supply) == pytest.approx(damping, abs=1e-4)


def test_limits_come_from_the_servos_data_sheet(duck: RobotDescription) -> None:
    np.testing.assert_allclose(duck.joints.torque, 1.91)


@pytest.mark.parametrize("pose", ["home", "ready", "crouch", "walk_ready"])
def test_it_stands_on_both_switches(pose: str) -> None:
    with Robot.open("duck") as robot:
        robot.start_at(pose)
        robot.run(_hold(robot, pose), 2.0)
        forces = [robot.twin.data.sensor(n).data[0] for n in robot.description.contacts.names]
        assert min(forces) > 5.0
        assert sum(forces) == pytest.approx(2.107141 * 9.81, rel=1e-2)
        assert not robot.fallen
        assert np.abs(robot.twin.data.qvel).max() < 0.02


def _hold(robot: Robot, pose: str) -> PoseHolder:
    return PoseHolder(robot.description.joints, robot.description.poses[pose], ramp=0.0)


@pytest.mark.parametrize("graph", ["squat", "look_around", "bow"])
def test_it_plays_its_graphs_on_both_feet(graph: str) -> None:
    with Robot.open("duck", noise=0.5) as robot:
        lowest = [np.inf]
        robot.watch.append(lambda seen: lowest.append(min(seen.contacts.min(), lowest[-1])))
        robot.play(graph, 6.0)
        assert not robot.fallen
        assert lowest[-1] > robot.description.contacts.threshold


def test_it_falls_open_loop_and_walks_with_balance() -> None:
    options = WalkOptions(open_loop=True)
    with Robot.open("duck", noise=0.2) as robot:
        assert robot.walk(0.1, steps=20, options=options).fell
    with Robot.open("duck", noise=0.2) as robot:
        assert robot.walk(0.1, steps=20).done
        assert not any(robot.backend.clamps.values())
