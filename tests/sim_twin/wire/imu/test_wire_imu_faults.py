"""An IMU that is silent, frozen or spinning, on a board and on a port of its own."""

import numpy as np
import pytest

from tests.sim_twin.wire.wire_host import Host, open_host
from tests.sim_twin.wire.wire_host1 import open_host1
from windup.hal.geometry.quaternion import euler_zxy
from windup.hal.imu.bno08x_rvc import decode
from windup.hal.imu.opencr import OpenCr
from windup.hal.joints import Array
from windup.sim_twin.twin import Twin
from windup.sim_twin.wire import unregister_world

BOARD = 200
MOTION = bytes((30, 0, 20, 0))
OP3 = "twin://op3?hold=no"
RVC = "twin://op3?hold=no&imu=rvc&bus=imu"
BODY, OWN = 2_000_000, 115_200  # baud
FRAME = 19  # bytes


def motion(host: Host) -> bytes:
    """Return the raw sample of the board."""
    return host.ask(BOARD, 2, MOTION)[0].parameters[1:]


def rates(host: Host) -> Array:
    imu = OpenCr("body").decode(motion(host), 0.0)
    assert imu.angular_velocity is not None
    return imu.angular_velocity


def test_a_board_whose_imu_is_silent_does_not_answer_and_the_servos_go_on() -> None:
    with open_host(f"{OP3}&faults=imu_silent:at=0.1:seconds=1", BODY) as host:
        assert len(host.ask(BOARD, 1)) == 1
        host.wait(0.2)
        assert host.ask(BOARD, 1) == [] and len(host.ask(13, 1)) == 1
        host.wait(1.0)
        assert len(host.ask(BOARD, 1)) == 1


def test_a_frozen_board_repeats_its_sample_to_the_bit_while_the_robot_falls() -> None:
    with open_host(f"{OP3}&faults=imu_frozen:at=0.2:seconds=1", BODY) as host:
        before = motion(host)
        host.wait(0.3)
        first = motion(host)
        assert first != before
        for _ in range(5):
            host.wait(0.1)
            assert motion(host) == first
        host.wait(1.0)
        assert motion(host) != first


def test_a_spinning_gyroscope_reads_a_constant_rate_and_the_accelerometer_is_true() -> None:
    with open_host("twin://op3?physics=inertia&faults=imu_spin:at=0.1:speed=2", BODY) as host:
        still = motion(host)
        host.wait(0.2)
        for _ in range(3):
            host.wait(0.1)
            assert rates(host) == pytest.approx([2.0, 0.0, 0.0], abs=2e-3)
            assert motion(host)[8:14] == still[8:14]


def test_an_imu_of_its_own_sends_nothing_while_it_is_silent() -> None:
    with open_host1(f"{RVC}&faults=imu_silent:at=0.105:seconds=0.5", OWN, 0.2) as host:
        assert len(host.port.read(FRAME * 10)) == FRAME * 10
        assert host.port.read(1) == b""
        host.wait(0.5)
        frame = host.port.read(FRAME)
        assert frame[:2] == b"\xaa\xaa" and frame[2] > 50  # it went on counting


def test_a_frozen_imu_of_its_own_counts_on_with_the_same_sample() -> None:
    with open_host1(f"{RVC}&faults=imu_frozen:at=0.105", OWN, 1.0) as host:
        host.port.read(FRAME * 11)
        frames = [host.port.read(FRAME) for _ in range(50)]
        assert len({frame[3:15] for frame in frames}) == 1
        assert len({frame[2] for frame in frames}) == 50


def test_the_attitude_of_a_spinning_imu_of_its_own_turns_with_its_rate() -> None:
    url = "twin://bench?imu=rvc&bus=imu&faults=imu_spin:at=0.105:speed=2"
    with open_host1(url, OWN, 1.0) as host:
        host.port.read(FRAME * 10)
        frames = [decode(host.port.read(FRAME)) for _ in range(30)]
        turns = [euler_zxy(*frame.angles) for frame in frames]
        angles = [2.0 * np.arctan2(turn[1], turn[0]) for turn in turns]
        assert np.diff(angles) == pytest.approx(0.02, abs=1e-3)
        assert len({tuple(frame.acceleration) for frame in frames}) == 1


def test_the_buses_of_a_world_fail_each_with_its_own_imu() -> None:
    url = "twin://op3?hold=no&imu=rvc&world=both&faults=imu_silent:at=0.1:bus=imu"
    with open_host(f"{url}&bus=body", BODY) as host:
        assert isinstance(host.world.owned[0], Twin)
        host.wait(0.2)
        assert len(host.ask(BOARD, 1)) == 1
        assert host.world.buses["imu"].imu is not None and host.world.buses["imu"].imu.silent
    unregister_world("both")
