from dataclasses import replace

import numpy as np
import pytest

from windup.hal.imu.opencr import OPENCR
from windup.robots import RobotDescription, load_robot
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.imu_errors import ImuErrors
from windup.sim_twin.twin import Twin

REST = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 9.81])
SILENT = replace(OPENCR, noise=(0.0, 0.0), bias=(0.0, 0.0))


@pytest.fixture(scope="module")
def robot() -> RobotDescription:
    return load_robot("op3")


def test_the_same_seed_gives_the_same_samples() -> None:
    first, again, other = (ImuErrors(OPENCR, 0.002, seed) for seed in (1, 1, 2))
    assert np.array_equal(first.sample(REST), again.sample(REST))
    assert not np.array_equal(first.sample(REST), other.sample(REST))


def test_samples_are_whole_counts() -> None:
    counts = ImuErrors(OPENCR, 0.002).sample(REST) / np.repeat(OPENCR.count_size, 3)
    assert counts == pytest.approx(np.rint(counts), abs=1e-6)


def test_noise_and_bias_are_as_large_as_their_figures() -> None:
    errors = ImuErrors(OPENCR, 0.002, seed=3)
    samples = np.array([errors.sample(REST) for _ in range(2000)]) - REST
    assert samples.mean(axis=0) == pytest.approx(errors.bias, abs=2e-3)
    density = np.repeat(OPENCR.noise, 3) * (0.5 * np.pi * OPENCR.cutoff) ** 0.5
    assert samples.std(axis=0) == pytest.approx(density, rel=0.2)


def test_the_filter_passes_the_whole_of_an_impact_later() -> None:
    errors = ImuErrors(SILENT, 0.002)
    errors.filter_motion(REST)
    hit = REST.copy()
    hit[3] = 50.0
    total = 0.0
    for step in range(50):
        errors.filter_motion(hit if step == 0 else REST)
        total += 0.002 * errors.sample(REST)[3]
    assert total == pytest.approx(0.002 * 50.0, rel=0.05)


def test_a_twin_with_a_perfect_imu_pays_nothing(robot: RobotDescription) -> None:
    twin = Twin(robot)
    observation = TwinBackend(twin).read()
    assert twin.on_step is None
    assert observation.imu is not None and observation.imu.orientation is not None


def test_a_twin_with_a_real_imu_has_its_errors_and_no_fused_orientation(
    robot: RobotDescription,
) -> None:
    twin = Twin(robot)
    errors = ImuErrors(OPENCR, twin.timestep, seed=4)
    backend = TwinBackend(twin, imu_errors=errors)
    backend.clock.wait_until(2.0)
    imu = backend.read().imu
    assert imu is not None and imu.orientation is None
    gyro = twin.data.sensordata[twin.model.sensor("gyro").adr[0] :][:3]
    assert imu.angular_velocity == pytest.approx(gyro + errors.bias[:3], abs=0.01)


def test_a_late_twin_has_late_samples(robot: RobotDescription) -> None:
    twin = Twin(robot)
    backend = TwinBackend(
        twin, sensor_delay=0.01, imu_errors=ImuErrors(OPENCR, twin.timestep, seed=4)
    )
    backend.clock.wait_until(0.1)
    observation = backend.read()
    assert observation.imu is not None and observation.imu.age == pytest.approx(0.01)
    assert observation.time == pytest.approx(0.09)
