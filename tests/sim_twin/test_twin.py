from pathlib import Path

import numpy as np
import pytest

from windup.hal.command import JointCommand
from windup.hal.errors import DivergedError, UnknownNameError
from windup.hal.joints import Array
from windup.robots import RobotDescription
from windup.sim_twin.backend import TwinBackend, TwinClock
from windup.sim_twin.push import Push
from windup.sim_twin.twin import Twin


def swing(twin: Twin, ticks: int, first: int = 0, steps: int = 2) -> bytes:
    """Move every joint about and return the bytes of the way the robot went."""
    backend = TwinBackend(twin)
    way = []
    for tick in range(first, first + ticks):
        pose = twin.robot.stance + 0.2 * np.sin(0.3 * tick + np.arange(len(twin.robot.joints)))
        backend.write(JointCommand.hold(twin.robot.joints, pose))
        twin.step(steps)
        way.append(np.concatenate([twin.data.qpos, twin.data.qvel]))
    return np.array(way).tobytes()


@pytest.fixture(params=["op3", "human"])
def robot(request: pytest.FixtureRequest) -> RobotDescription:
    described: RobotDescription = request.getfixturevalue(request.param)
    return described


def test_it_begins_at_rest_on_the_floor_in_its_stance(robot: RobotDescription) -> None:
    twin = Twin(robot)
    np.testing.assert_array_equal(twin.data.qpos[7:], robot.stance)
    assert not twin.data.qvel.any()
    soles = [twin.data.site(foot.site).xpos[2] for foot in robot.feet]
    assert min(soles) == pytest.approx(0.0, abs=1e-9)
    assert not twin.fallen
    assert twin.time == 0.0


def test_it_stands(robot: RobotDescription) -> None:
    twin = Twin(robot)
    height = twin.base.position[2]
    twin.step(round(0.5 / twin.timestep))
    assert not twin.fallen
    assert twin.base.position[2] == pytest.approx(height, rel=0.05)


def test_noise_on_the_start_pose_is_the_seeds(op3: RobotDescription) -> None:
    def start(seed: int, noise: float = 0.2) -> Array:
        twin = Twin(op3)
        twin.reset(noise=noise, seed=seed)
        return twin.data.qpos[7:] - op3.stance

    np.testing.assert_array_equal(start(1), start(1))
    assert not np.array_equal(start(1), start(2))
    spread = np.degrees(np.std([start(seed) for seed in range(20)]))
    assert spread == pytest.approx(0.2, rel=0.15)
    assert not start(1, noise=0.0).any()


def test_the_same_run_twice_gives_the_same_bytes(robot: RobotDescription) -> None:
    runs = []
    for _ in range(2):
        twin = Twin(robot)
        twin.reset(noise=0.5, seed=3)
        runs.append(swing(twin, 60))
    assert runs[0] == runs[1]
    other = Twin(robot)
    other.reset(noise=0.5, seed=4)
    assert swing(other, 60) != runs[0]


def test_reset_leaves_nothing_of_the_run_before(robot: RobotDescription) -> None:
    twin = Twin(robot, delay=0.008)
    fresh = swing(twin, 40)
    twin.push(Push.impulse(robot.torso, 1.0, 0.0, start=twin.time, duration=10.0))
    twin.step(5)
    twin.reset()
    assert swing(twin, 40) == fresh


@pytest.mark.parametrize("delay", [0.0, 0.008])
def test_a_restored_twin_has_the_same_future_bit_for_bit(
    robot: RobotDescription, delay: float
) -> None:
    twin = Twin(robot, delay=delay)
    swing(twin, 30)
    state = twin.save()
    future = swing(twin, 40, first=30)
    swing(twin, 10)
    twin.restore(state)
    assert swing(twin, 40, first=30) == future


@pytest.mark.parametrize(
    ("start", "duration"),
    [(0.03, 10.0), (0.03, 0.05), (0.07, 0.04)],
    ids=["lasting", "ending", "to come"],
)
def test_a_restored_twin_is_pushed_as_it_would_have_been(
    robot: RobotDescription, start: float, duration: float
) -> None:
    twin = Twin(robot)
    force = np.array([0.0, robot.joints.stiffness.max() / 10.0, 0.0])
    twin.push(Push(robot.torso, force, start, duration))
    twin.step(round(0.05 / twin.timestep))
    state = twin.save()
    future = swing(twin, 40)
    twin.restore(state)
    assert swing(twin, 40) == future


def test_a_push_from_after_the_save_is_not_felt_by_the_restored_twin(
    op3: RobotDescription,
) -> None:
    twin = Twin(op3)
    state = twin.save()
    future = swing(twin, 20)
    twin.restore(state)
    twin.push(Push.impulse(op3.torso, 1.0, 0.0, start=0.0, duration=10.0))
    twin.step(1)
    twin.restore(state)
    assert swing(twin, 20) == future


# Pushes


def floating(robot: RobotDescription) -> Twin:
    """Return a limp robot in empty space."""
    twin = Twin(robot)
    twin.model.opt.gravity[:] = 0.0
    twin.data.qpos[2] += 5.0
    twin.powered = False
    return twin


def momentum(twin: Twin) -> Array:
    """Return the linear momentum of the whole robot, N s."""
    velocity: Array = twin.data.sensor("com_velocity").data
    return float(twin.model.body_mass.sum()) * velocity


@pytest.mark.parametrize("direction", [0.0, 1.0, np.pi])
@pytest.mark.parametrize("duration", [0.1, 0.02])
def test_the_momentum_of_a_push_is_its_impulse(
    robot: RobotDescription, direction: float, duration: float
) -> None:
    twin = floating(robot)
    impulse = 0.05 * float(twin.model.body_mass.sum())
    twin.push(Push.impulse(robot.torso, impulse, direction, start=0.02, duration=duration))
    twin.step(round(0.2 / twin.timestep))
    wanted = impulse * np.array([np.cos(direction), np.sin(direction), 0.0])
    np.testing.assert_allclose(momentum(twin), wanted, atol=2e-3 * impulse)


def test_an_impulse_shorter_than_a_physics_step_is_no_bigger_for_it(
    op3: RobotDescription,
) -> None:
    twin = floating(op3)
    twin.push(Push.impulse(op3.torso, 0.2, 0.0, start=0.0, duration=0.001))
    twin.step(10)
    np.testing.assert_allclose(momentum(twin), [0.2, 0.0, 0.0], atol=1e-3)


def test_a_push_begins_at_its_time_and_ends(op3: RobotDescription) -> None:
    twin = floating(op3)
    twin.push(Push(op3.torso, np.array([1.0, 0.0, 0.0]), start=0.1, duration=0.1))
    twin.step(round(0.1 / twin.timestep))
    assert not twin.data.qvel.any()
    twin.step(round(0.05 / twin.timestep))
    assert twin.data.qvel[0] > 0.0
    twin.step(round(0.1 / twin.timestep))
    assert not twin.data.xfrc_applied.any()


def test_two_pushes_at_once_add_up(op3: RobotDescription) -> None:
    twin = floating(op3)
    for direction in (0.0, np.pi / 2):
        twin.push(Push.impulse(op3.torso, 0.1, direction, start=0.0))
    twin.step(round(0.15 / twin.timestep))
    np.testing.assert_allclose(momentum(twin), [0.1, 0.1, 0.0], atol=1e-3)


@pytest.mark.parametrize(("height", "sign"), [(0.2, 1.0), (-0.2, -1.0)])
def test_a_push_above_the_centre_of_mass_tips_the_robot_the_way_it_goes(
    op3: RobotDescription, height: float, sign: float
) -> None:
    twin = floating(op3)
    twin.push(Push.impulse(op3.torso, 0.1, 0.0, start=0.0, duration=0.05, height=height))
    twin.step(round(0.05 / twin.timestep))
    assert sign * twin.base.angular_velocity[1] > 0.1


def test_a_body_that_is_not_there_is_named(op3: RobotDescription) -> None:
    with pytest.raises(UnknownNameError, match=r"unknown body 'body_lnk'; did you mean 'body_link"):
        Twin(op3).push(Push.impulse("body_lnk", 1.0, 0.0, start=0.0))


# Torque off, and physics that fails


def test_a_robot_without_torque_is_limp(robot: RobotDescription) -> None:
    twin = Twin(robot)
    backend = TwinBackend(twin)
    twin.step(20)
    assert np.abs(twin.data.qfrc_actuator).max() > 0.01
    assert backend.set_torque(False).all_off
    twin.step(1)
    assert not twin.data.qfrc_actuator.any()
    twin.step(round(3.0 / twin.timestep))
    assert twin.fallen
    assert backend.set_torque(True).all_on
    twin.step(1)
    assert np.abs(twin.data.qfrc_actuator).max() > 0.01


def test_a_twin_that_diverges_says_when_and_at_which_joint(
    human: RobotDescription, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # MuJoCo writes its log there
    twin = Twin(human)
    block = JointCommand.hold(human.joints, human.stance).block.copy()
    block[:, human.joints.index("l_elbow")] = [0.1, 0.0, 0.0, 1e5, 0.0]
    TwinBackend(twin).write(JointCommand(block))
    with pytest.raises(DivergedError) as error:
        for _ in range(200):
            twin.step(1)
    assert str(error.value) == (
        f"the twin diverged at {twin.time:.3f} s, first at joint 'l_elbow'; "
        "lower its stiffness or the physics time step"
    )


@pytest.mark.parametrize("steps", [1, 2, 5])
def test_a_twin_that_is_no_number_says_so_too(
    op3: RobotDescription, steps: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    twin = Twin(op3)
    twin.data.qpos[9] = np.nan
    with pytest.raises(DivergedError, match=r"the twin diverged at 0\.0\d\d s, first at "):
        twin.step(steps)


def test_a_fall_is_a_low_base_or_a_tilted_torso(op3: RobotDescription) -> None:
    low, tilted = Twin(op3), Twin(op3)
    low.data.qpos[2] = op3.fall.height - 0.001
    assert low.fallen
    tilt = op3.fall.tilt + 0.01
    tilted.data.qpos[3:7] = [np.cos(tilt / 2), 0.0, np.sin(tilt / 2), 0.0]
    tilted.restore(tilted.save())
    assert tilted.fallen


# The clock


def test_waiting_steps_the_physics_to_that_time_and_not_beyond(robot: RobotDescription) -> None:
    clock = TwinClock(Twin(robot))
    for tick in range(1, 20):
        clock.wait_until(tick * 0.008)
        assert clock.now() == pytest.approx(tick * 0.008, abs=1e-9)
    clock.wait_until(0.0)
    assert clock.now() == pytest.approx(19 * 0.008, abs=1e-9)


@pytest.mark.parametrize(("front", "x"), [(True, -1.0), (False, 1.0)])
def test_a_robot_lies_where_it_was_laid(op3: RobotDescription, front: bool, x: float) -> None:
    twin = Twin(op3)
    twin.lay_down(front, np.zeros(len(twin.robot.joints)), noise=1.0, seed=3)
    assert twin.data.ncon == 0 or twin.data.contact.dist.min() > -0.002
    twin.step(500)
    assert twin.fallen
    forward = twin.data.xmat[twin.model.body(twin.robot.torso).id].reshape(3, 3)[:, 0]
    assert forward[2] == pytest.approx(x, abs=0.2)
    assert np.abs(twin.data.qvel[:6]).max() < 0.1


def test_it_lies_in_another_direction_for_another_seed(op3: RobotDescription) -> None:
    twin = Twin(op3)
    bases = []
    for seed in (1, 1, 2):
        twin.lay_down(True, np.zeros(len(twin.robot.joints)), seed=seed)
        bases.append(twin.data.qpos[:7].copy())
    np.testing.assert_array_equal(bases[0], bases[1])
    assert np.abs(bases[0] - bases[2]).max() > 0.1
