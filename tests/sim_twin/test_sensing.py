from math import pi

import numpy as np
import pytest

from windup.hal.command import JointCommand
from windup.robots import RobotDescription
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.twin import Twin

COUNTS = 4096 / (2.0 * pi)


@pytest.fixture(params=["op3", "human"])
def robot(request: pytest.FixtureRequest) -> RobotDescription:
    described: RobotDescription = request.getfixturevalue(request.param)
    return described


def moved(robot: RobotDescription, **options: float) -> TwinBackend:
    """Return a backend whose robot has been told to bend, a moment ago."""
    backend = TwinBackend(Twin(robot, delay=options.pop("delay", None)), **options)  # type: ignore[arg-type]
    backend.write(JointCommand.hold(robot.joints, robot.stance + 0.1))
    backend.clock.wait_until(0.1)
    return backend


@pytest.mark.parametrize("steps", [0, 1, 4, 10])
@pytest.mark.parametrize("name", ["op3", "human"])
def test_a_command_acts_after_exactly_its_delay(
    name: str, steps: int, request: pytest.FixtureRequest
) -> None:
    robot: RobotDescription = request.getfixturevalue(name)
    timestep = Twin(robot).timestep
    told, left_alone = (Twin(robot, delay=steps * timestep) for _ in range(2))
    for twin in (told, left_alone):
        TwinBackend(twin).write(JointCommand.hold(robot.joints, robot.stance))
        twin.step(17)
    TwinBackend(told).write(JointCommand.hold(robot.joints, robot.stance + 0.1))
    for _ in range(steps):
        told.step(1)
        left_alone.step(1)
        assert told.data.qvel.tobytes() == left_alone.data.qvel.tobytes()
    told.step(1)
    left_alone.step(1)
    assert told.data.qvel.tobytes() != left_alone.data.qvel.tobytes()


@pytest.mark.parametrize("delay", [0.004, 0.02])
def test_delayed_sensors_show_what_was_then(robot: RobotDescription, delay: float) -> None:
    late = moved(robot, sensor_delay=delay)
    prompt = TwinBackend(Twin(robot), sensor_delay=0.0)
    prompt.write(JointCommand.hold(robot.joints, robot.stance + 0.1))
    prompt.clock.wait_until(0.1 - delay)
    then, seen = prompt.read(), late.read()
    assert seen.time == pytest.approx(0.1 - delay, abs=1e-9)
    np.testing.assert_array_equal(seen.joints.position, then.joints.position)
    np.testing.assert_array_equal(seen.joints.velocity, then.joints.velocity)
    np.testing.assert_array_equal(seen.contacts, then.contacts)
    assert seen.base is not None
    assert then.base is not None
    np.testing.assert_array_equal(seen.base.position, then.base.position)
    np.testing.assert_array_equal(seen.joints.age, np.full(len(robot.joints), delay))
    assert seen.imu is not None
    assert seen.imu.age == delay


def test_delayed_sensors_forget_what_came_before_a_reset(op3: RobotDescription) -> None:
    backend = moved(op3, sensor_delay=0.02)
    backend.twin.reset()
    seen = backend.read()
    assert seen.time == 0.0
    np.testing.assert_allclose(seen.joints.position, op3.stance, atol=1.0 / COUNTS)


def test_encoders_count(op3: RobotDescription) -> None:
    backend = moved(op3)
    seen, truth = backend.read().joints.position, backend.twin.data.qpos[7:]
    np.testing.assert_allclose(seen * COUNTS, np.rint(seen * COUNTS), atol=1e-6)
    assert 0.0 < np.abs(seen - truth).max() <= 0.5 / COUNTS + 1e-12


def test_ideal_joints_are_seen_as_they_are(human: RobotDescription) -> None:
    backend = moved(human)
    np.testing.assert_array_equal(backend.read().joints.position, backend.twin.data.qpos[7:])


def test_an_observation_stays_as_it_was_when_time_goes_on(robot: RobotDescription) -> None:
    backend = moved(robot)
    seen = backend.read()
    assert seen.base is not None
    assert seen.imu is not None
    parts = (seen.joints.position, seen.joints.velocity, seen.contacts, seen.base.position)
    before = [part.copy() for part in (*parts, seen.imu.acceleration)]
    backend.clock.wait_until(0.3)
    for part, old in zip((*parts, seen.imu.acceleration), before, strict=True):
        np.testing.assert_array_equal(part, old)


def test_a_robot_at_rest_feels_gravity_upward_and_its_own_weight(robot: RobotDescription) -> None:
    backend = TwinBackend(Twin(robot))
    backend.write(JointCommand.hold(robot.joints, robot.stance))
    backend.clock.wait_until(1.0)
    seen = backend.read()
    assert seen.imu is not None
    assert np.linalg.norm(seen.imu.acceleration) == pytest.approx(9.81, rel=0.1)
    assert seen.imu.acceleration[2] > 9.0
    weight = 9.81 * float(backend.twin.model.body_mass.sum())
    assert seen.contacts.sum() == pytest.approx(weight, rel=0.1)


def test_the_true_base_is_there_only_where_it_is_asked_for(op3: RobotDescription) -> None:
    assert TwinBackend(Twin(op3)).read().base is not None
    assert TwinBackend(Twin(op3), true_base=False).read().base is None
