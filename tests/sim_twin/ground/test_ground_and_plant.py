"""A twin's ground, its differences from its files, and its legs."""

import mujoco
import numpy as np
import pytest

from windup.robots import RobotDescription, load_robot
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.environment import Environment, build_model
from windup.sim_twin.ground.clearance import FootClearance
from windup.sim_twin.ground.foot_level import FootLevel
from windup.sim_twin.ground.terrain import Ground
from windup.sim_twin.plant import Plant
from windup.sim_twin.push import Push
from windup.sim_twin.twin import Twin


@pytest.fixture(scope="module")
def op3() -> RobotDescription:
    return load_robot("op3")


def ray_height(model: mujoco.MjModel, x: float) -> float:
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    down = np.array([0.0, 0.0, -1.0])
    hit = np.zeros(1, dtype=np.int32)
    start = np.array([x, 5.0, 3.0])
    return 3.0 - float(mujoco.mj_ray(model, data, start, down, None, 1, -1, hit))


GROUNDS = [
    Ground(slope=4.0),
    Ground(slope=-4.0),
    Ground(strips=0.02),
    Ground(stairs=0.04),
    Ground(stairs=-0.04),
    Ground(rough=0.05, seed=3),
]


@pytest.mark.parametrize("ground", GROUNDS)
def test_the_tiles_are_as_high_as_the_ground_says(op3: RobotDescription, ground: Ground) -> None:
    model = build_model(op3, world=Environment(ground))
    for x in (-1.0, 0.3, 0.7, 2.1, 5.05):
        assert ray_height(model, x) == pytest.approx(ground.height(x, 5.0), abs=1e-6)


def test_stairs_go_up_by_their_height_and_rough_ground_to_both_sides() -> None:
    stairs = Ground(stairs=0.04, start=1.0, strip=0.25)
    heights = [stairs.height(x) for x in (0.9, 1.1, 1.4, 1.6, 2.1)]
    assert heights == pytest.approx([0.0, 0.04, 0.04, 0.08, 0.12])
    rough = Ground(rough=0.05, start=1.0, strip=0.25, seed=1)
    heights = [rough.height(x, y) for x in np.arange(1.1, 20.0, 0.3) for y in (-3.0, 0.0, 3.0)]
    assert 0.04 < max(heights) <= 0.05 and -0.05 <= min(heights) < -0.04
    assert rough.height(1.0, 0.3) == 0.0
    assert rough.height(3.0, 0.3) != Ground(rough=0.05, start=1.0, seed=2).height(3.0, 0.3)


def test_flat_ground_changes_nothing(op3: RobotDescription) -> None:
    assert build_model(op3).ngeom == build_model(op3, world=Environment(Ground())).ngeom


def test_a_plant_changes_mass_gains_friction_delay_and_supply(op3: RobotDescription) -> None:
    plant = Plant(1.1, friction_loss=0.2, delay=0.016, floor=0.6, mass=1.05, supply=11.0)
    twin, nominal = Twin(op3, world=Environment(plant=plant)), Twin(op3)
    ratio = twin.model.body_mass.sum() / nominal.model.body_mass.sum()
    assert ratio == pytest.approx(1.05)
    assert twin.delay == 0.016 and twin.supply == 11.0
    assert (twin.model.dof_frictionloss[6:] == 0.2).all()
    assert twin.model.geom("floor").friction[0] == twin.model.geom("l_sole").friction[0] == 0.6


def test_a_plant_is_stiffer_whatever_gains_are_sent(op3: RobotDescription) -> None:
    from windup.hal.command import JointCommand

    command = JointCommand.hold(op3.joints, op3.stance)
    usual = TwinBackend(Twin(op3)).write(command).stiffness
    stiff = TwinBackend(Twin(op3, world=Environment(plant=Plant(1.2)))).write(command).stiffness
    assert stiff == pytest.approx(1.2 * usual)


def test_random_plants_stay_in_their_ranges() -> None:
    op3 = load_robot("op3")
    plants = [Plant.random(seed, op3) for seed in range(40)]
    assert plants[3] == Plant.random(3, op3)
    assert all(10.5 <= (p.supply or 0.0) <= 12.6 for p in plants)
    assert all(0.004 <= (p.delay or 0.0) <= 0.024 and 0.8 <= p.stiffness <= 1.2 for p in plants)


def test_a_random_plant_has_the_servos_of_its_robot() -> None:
    duck = load_robot("duck")
    plants = [Plant.random(seed, duck) for seed in range(40)]
    assert all(6.4 <= (p.supply or 0.0) <= 7.8 for p in plants)
    assert max(p.friction_loss or 0.0 for p in plants) < 0.15


@pytest.mark.parametrize("name", ["op3", "human"])
def test_crossed_legs_touch_only_when_they_may_collide(name: str) -> None:
    robot = load_robot(name)
    for collide in (False, True):
        twin = Twin(robot, world=Environment(self_collision=collide))
        clearance = FootClearance(robot, twin.model, twin.data)
        assert clearance.update() > 0.0
        roll = robot.joints.index("l_hip_roll")
        inward = 0.2
        twin.data.qpos[2] += 1.0
        twin.data.qpos[7 + roll] = inward
        mujoco.mj_forward(twin.model, twin.data)
        assert clearance.update() < 0.0
        assert (twin.data.ncon > 0) == collide
    assert clearance.smallest < 0.0


def test_the_foot_feels_how_high_it_stands(op3: RobotDescription) -> None:
    level = FootLevel(op3)
    twin = Twin(op3)
    twin.step(100)
    observation = TwinBackend(twin).read()
    assert level.of(observation) == 0.0
    assert observation.base is not None
    observation.base.position[2] += 0.03
    assert level.of(observation) == pytest.approx(0.03, abs=0.002)


def test_a_velocity_step_moves_the_whole_robot(op3: RobotDescription) -> None:
    twin = Twin(op3)
    twin.data.qpos[2] += 1.0
    mass = float(twin.model.body_mass.sum())
    twin.push(Push.velocity_step(0.4, mass, np.pi / 2.0, start=0.0))
    twin.step(12)
    mujoco.mj_subtreeVel(twin.model, twin.data)
    velocity = twin.data.subtree_linvel[1]
    assert velocity[:2] == pytest.approx([0.0, 0.4], abs=1e-3)


def test_a_push_on_the_whole_robot_gives_its_impulse_whatever_its_instants(
    op3: RobotDescription,
) -> None:
    twin = Twin(op3)
    twin.data.qpos[2] += 1.0
    mass = float(twin.model.body_mass.sum())
    twin.push(Push.velocity_step(0.4, mass, 0.0, start=0.0007, duration=0.0051))
    twin.step(10)
    mujoco.mj_forward(twin.model, twin.data)
    velocity = twin.data.sensor("com_velocity").data
    np.testing.assert_allclose(velocity[:2], [0.4, 0.0], atol=1e-3)


def test_a_foot_that_sinks_into_the_floor_stands_on_the_floor(human: RobotDescription) -> None:
    level = FootLevel(human)
    twin = Twin(human)
    twin.step(500)
    observation = TwinBackend(twin).read()
    assert observation.base is not None
    observation.base.position[2] -= 0.008
    assert level.of(observation) == 0.0
    observation.base.position[2] += 0.048
    assert level.of(observation) == pytest.approx(0.04, abs=0.005)
