from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.hal.fake_bus import FakeSerial, VirtualClock
from tests.hal.fake_bus1 import STS
from tests.hal.mixed_robot import Wires, mount, robot, ticks
from windup.hal.imu.bno08x_rvc import WIRE_TIME, Bno08xRvc, FrameParser
from windup.hal.port.port import Port

EXAMPLE = bytes.fromhex("AAAADE010092FF25088DFEECFFD103000000E7")  # of the data sheet


def rvc(index: int, degrees: tuple[float, float, float], g: tuple[float, ...] = (0, 0, 1)) -> bytes:
    counts = [round(100 * angle) for angle in degrees] + [round(1000 * value) for value in g]
    body = bytes([index % 256]) + b"".join(c.to_bytes(2, "little", signed=True) for c in counts)
    body += bytes(3)
    return b"\xaa\xaa" + body + bytes([sum(body) & 0xFF])


def listening(mounting: tuple[float, ...] = (1, 0, 0, 0)) -> tuple[FakeSerial, Bno08xRvc]:
    serial = FakeSerial([])
    imu = Bno08xRvc("fake://imu", np.array(mounting))
    imu.attach(Port(serial, "fake://imu"))
    return serial, imu


def send(serial: FakeSerial, imu: Bno08xRvc, data: bytes, wait: float = 0.01) -> None:
    serial.clock.time += wait
    serial.arrivals += [(serial.clock.time, byte) for byte in data]
    imu.poll()


def test_the_data_sheets_example_is_decoded_and_gravity_is_where_the_angles_say() -> None:
    serial, imu = listening()
    send(serial, imu, EXAMPLE)
    state = imu.state(serial.clock.now())
    assert state is not None and state.orientation is not None
    assert state.acceleration / 9.80665 == pytest.approx([-0.371, -0.020, 0.977])
    w, x, y, z = state.orientation
    up = [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]
    assert up == pytest.approx([-0.356, -0.019, 0.934], abs=1e-3)
    assert state.angular_velocity.tolist() == [0.0] * 3
    assert state.age == pytest.approx(WIRE_TIME)


@given(st.lists(st.binary(max_size=12), min_size=4, max_size=4), st.integers(1, 60))
def test_frames_are_found_between_noise_however_the_bytes_arrive(
    noise: list[bytes], piece: int
) -> None:
    quiet = [part.replace(b"\xaa", b"\xab") for part in noise]
    frames = [rvc(index, (index, -index, 2 * index)) for index in range(3)]
    stream = quiet[0] + b"".join(f + q for f, q in zip(frames, quiet[1:], strict=True))
    parser = FrameParser()
    found = [
        frame.number
        for at in range(0, len(stream), piece)
        for frame in parser.feed(stream[at : at + piece])
    ]
    assert found == [0, 1, 2]


@given(st.integers(0, 56), st.integers(1, 255))
def test_a_wrong_byte_costs_one_frame(place: int, flip: int) -> None:
    stream = bytearray(b"".join(rvc(index, (10, 5, 3)) for index in range(3)) + b"\x00")
    stream[place] ^= flip
    found = [frame.number for frame in FrameParser().feed(bytes(stream))]
    assert found == [index for index in range(3) if index != place // 19]


@pytest.mark.parametrize(
    ("axis", "angles"),
    [(2, (178.0, 0, 0)), (2, (-40.0, 0, 0)), (0, (0, 20.0, 0)), (1, (0, 0, 80.0))],
)
def test_rates_are_the_turn_between_frames_through_the_wrap(
    axis: int, angles: tuple[float, float, float]
) -> None:
    serial, imu = listening()
    where = [2, 0, 1].index(axis)
    for index in range(6):
        turned = list(angles)
        turned[where] = (turned[where] + 1.0 * index + 180.0) % 360.0 - 180.0
        send(serial, imu, rvc(250 + index, (turned[0], turned[1], turned[2])))
    state = imu.state(serial.clock.now())
    expected = np.zeros(3)
    expected[axis] = 100.0 * pi / 180.0
    assert state is not None and state.angular_velocity == pytest.approx(expected, abs=0.02)


def test_lost_frames_are_counted_by_the_index() -> None:
    serial, imu = listening()
    send(serial, imu, rvc(7, (0, 0, 0)))
    send(serial, imu, rvc(11, (4.0, 0, 0)), wait=0.04)
    state = imu.state(serial.clock.now())
    assert state is not None and state.angular_velocity[2] == pytest.approx(100 * pi / 180)


def test_behind_a_long_hole_the_last_sample_ages_until_two_frames_show_the_rates() -> None:
    serial, imu = listening()
    for index in range(2):
        send(serial, imu, rvc(index, (1.0 * index, 0, 0)))
    send(serial, imu, rvc(40, (40.0, 0, 0)), wait=0.4)
    state = imu.state(serial.clock.now())
    assert state is not None and state.age > 0.3, "rates of 0 would look like a jump"
    send(serial, imu, rvc(41, (41.0, 0, 0)))
    state = imu.state(serial.clock.now())
    assert state is not None and state.age < 0.02
    assert state.angular_velocity[2] == pytest.approx(100 * pi / 180)


def test_the_body_is_not_the_chip() -> None:
    # The chip lies on its back: x ahead, z down.
    serial, imu = listening((0, 1, 0, 0))
    for index in range(2):
        send(serial, imu, rvc(index, (1.0 * index, 0, 180.0), (0, 0, -1)))
    state = imu.state(serial.clock.now())
    assert state is not None and state.orientation is not None
    assert state.acceleration == pytest.approx([0, 0, 9.80665], abs=1e-9)
    assert np.linalg.norm(state.angular_velocity) == pytest.approx(100 * pi / 180, rel=1e-2)
    assert state.angular_velocity[2] == pytest.approx(100 * pi / 180, rel=1e-2)


def test_a_turn_that_cannot_be_is_refused_and_the_sample_ages() -> None:
    serial, imu = listening()
    send(serial, imu, rvc(0, (0, 0, 0)))
    send(serial, imu, rvc(1, (90.0, 0, 0)))
    send(serial, imu, rvc(1, (0, 120.0, 0)))
    assert imu.implausible == 2
    state = imu.state(serial.clock.now())
    assert state is not None and state.age == pytest.approx(0.02 + WIRE_TIME)
    send(serial, imu, rvc(3, (0.1, 0, 0)))
    again = imu.state(serial.clock.now())
    assert again is not None and again.age == pytest.approx(WIRE_TIME)


def test_the_backend_listens_beside_its_buses_and_survives_an_unplugged_imu() -> None:
    wires = Wires()
    wires.add("body", {1: STS})
    wires.add("imu", {})
    backend = robot(wires, [mount(STS, "body", 1)], imu=Bno08xRvc("imu"))
    backend.connect()
    backend.configure()
    assert backend.read().imu is None
    for index in range(3):
        wires["imu"].arrivals = [(wires.clock.now(), b) for b in rvc(index, (0, 0, 0))]
        ticks(backend, 1)
    imu = backend.read().imu
    assert imu is not None and imu.age < 0.01
    wires.unplugged.add("imu")
    ticks(backend, 40)
    imu = backend.read().imu
    assert imu is not None and imu.age > 0.3 and wires.open == 1
    wires.unplugged.clear()
    ticks(backend, 40)
    for index in (9, 10):  # rates need two
        wires["imu"].arrivals = [(wires.clock.now(), b) for b in rvc(index, (0, 0, 0))]
        ticks(backend, 1)
    imu = backend.read().imu
    assert imu is not None and imu.age < 0.01
    backend.disconnect()
    assert wires.open == 0
    assert isinstance(backend.clock, VirtualClock)
