"""A BNO08x in UART-RVC mode on a port of its own."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.sim_twin.wire.wire_host1 import open_host1
from windup.hal.geometry.gravity import STANDARD_GRAVITY
from windup.hal.geometry.quaternion import euler_zxy
from windup.hal.imu.bno08x_rvc import decode
from windup.sim_twin.twin import Twin
from windup.sim_twin.wire import unregister_world
from windup.sim_twin.wire.boards.rvc import encode_rvc

EXAMPLE = "AA AA DE 01 00 92 FF 25 08 8D FE EC FF D1 03 00 00 00 E7"  # of the data sheet


def turned(yaw: float, pitch: float, roll: float) -> np.ndarray:
    """Return the quaternion of turns about z, then x, then y, degrees."""
    turns = Rotation.from_euler("ZXY", [yaw, pitch, roll], degrees=True)
    return np.roll(turns.as_quat(), 1)


class Example:
    silent = False
    angular_velocity = np.zeros(3)
    acceleration = np.array([-0.371, -0.020, 0.977]) * STANDARD_GRAVITY
    orientation = turned(0.01, -1.10, 20.85)


def test_the_data_sheets_frame() -> None:
    assert encode_rvc(222, Example()) == bytes.fromhex(EXAMPLE)


@pytest.mark.parametrize("angles", [(30, 10, -20), (-170, 60, 5), (0, -85, 120), (90, 0, 179)])
def test_the_driver_and_it_mean_the_same_angles(angles: tuple[float, float, float]) -> None:
    imu = Example()
    imu.orientation = turned(*angles)
    read = euler_zxy(*decode(encode_rvc(0, imu)).angles)
    assert abs(read @ imu.orientation) == pytest.approx(1.0, abs=1e-6)


def test_the_data_sheets_angles_are_where_its_gravity_is() -> None:
    up = Rotation.from_quat(np.roll(Example.orientation, -1)).inv().apply([0.0, 0.0, 1.0])
    felt = Example.acceleration / np.linalg.norm(Example.acceleration)
    assert up == pytest.approx(felt, abs=0.02)


def test_a_hundred_frames_a_second_come_unasked() -> None:
    with open_host1("twin://bench?imu=rvc&bus=imu", baud=115_200, timeout=1.0) as host:
        frames = [host.port.read(19) for _ in range(100)]
        assert host.now == pytest.approx(1.0 + 19 * 10 / 115_200, abs=1e-6)
        assert [frame[2] for frame in frames] == list(range(100))
        assert all(frame[:2] == b"\xaa\xaa" for frame in frames)
        assert all(sum(frame[2:18]) & 0xFF == frame[18] for frame in frames)


def test_what_nobody_reads_is_forgotten_by_and_by() -> None:
    with open_host1("twin://bench?imu=rvc&bus=imu", baud=115_200) as host:
        host.wait(10.0)
        assert 0 < host.port.in_waiting < 4200
        host.port.write(b"nobody listens")


def test_at_another_baud_rate_there_is_noise() -> None:
    with open_host1("twin://bench?imu=rvc&bus=imu", baud=9600, timeout=0.1) as host:
        assert not host.port.read(19).startswith(b"\xaa\xaa")


def test_it_feels_the_twin_and_shares_its_clock() -> None:
    url = "twin://op3?imu=rvc&world=rvc&hold=no"
    with (
        open_host1(f"{url}&bus=imu", baud=115_200, timeout=0.5) as imu,
        open_host1(f"{url}&bus=body", timeout=0.5) as body,
    ):
        (twin,) = imu.world.owned
        assert isinstance(twin, Twin)
        twin.data.qpos[3:7] = turned(30.0, 10.0, -20.0)
        frame = imu.port.read(19)
        angles = np.frombuffer(frame[3:9], "<i2") / 100.0
        assert angles == pytest.approx([30.0, 10.0, -20.0], abs=1.0)
        assert body.now == imu.now
    unregister_world("rvc")


def test_faults_hit_it_too() -> None:
    url = "twin://bench?imu=rvc&bus=imu&faults=corrupt:0.5&seed=1"
    with open_host1(url, baud=115_200, timeout=1.0) as host:
        frames = [host.port.read(19) for _ in range(100)]
        wrong = sum(sum(f[2:18]) & 0xFF != f[18] or f[:2] != b"\xaa\xaa" for f in frames)
        assert wrong == pytest.approx(50, abs=20)
