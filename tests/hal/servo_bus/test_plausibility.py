from math import pi

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.hal.fake_bus1 import SCS, STS
from tests.hal.mixed_robot import Wires, mount, robot, ticks
from windup.hal.protocols import protocol1
from windup.hal.servo_bus.plausibility import Plausibility

YES = np.array([True])


def check(last: float = 4095.0, speed: float = 4000.0) -> Plausibility:
    return Plausibility(np.array([last]), np.array([speed]), np.array([1.0]))


def accept(plausible: Plausibility, position: float, velocity: float, now: float) -> bool:
    return bool(plausible.accept(np.array([position]), np.array([velocity]), YES, now)[0])


def test_the_first_reading_needs_a_second_that_agrees() -> None:
    plausible = check()
    assert not accept(plausible, 3000, 0, 0.0)
    assert not accept(plausible, 1000, 0, 0.01)
    assert accept(plausible, 1010, 0, 0.02)


def test_a_jump_a_speed_and_a_place_that_cannot_be_are_refused() -> None:
    plausible = check()
    accept(plausible, 1000, 0, 0.0)
    assert accept(plausible, 1000, 0, 0.01)
    assert not accept(plausible, 3048, 0, 0.02)
    assert not accept(plausible, 1001, 30_000, 0.02)
    assert not accept(plausible, -5, 0, 0.02)
    assert not accept(plausible, 4096, 0, 0.02)
    assert accept(plausible, 1040, 3900, 0.02)
    assert plausible.rejected == 4  # the first reading is not refused, it waits


def test_after_a_true_jump_a_joint_is_believed_again_within_a_moment() -> None:
    plausible = check()
    accept(plausible, 1000, 0, 0.0)
    accept(plausible, 1000, 0, 0.0)
    times = np.arange(0.0, 1.0, 0.01)
    assert any(accept(plausible, 3000, 0, now) for now in times)
    assert accept(plausible, 3000, 0, 1.0)


@given(st.floats(0.0, 1.0), st.floats(0.001, 0.1))
def test_what_a_motor_can_do_is_believed(phase: float, period: float) -> None:
    plausible = check()
    rate = 4000.0 / 1500.0
    for tick in range(60):
        now = tick * period
        position = 2048 + 1500 * np.sin(rate * now + phase)
        good = accept(plausible, position, 4000 * np.cos(rate * now + phase), now)
        assert good or tick < 2


@settings(max_examples=30, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 5), st.integers(0, 255)), min_size=40, max_size=40))
def test_broken_frames_with_a_good_checksum_move_no_joint_far(flips: list[tuple[int, int]]) -> None:
    wires = Wires()
    wires.add("body", {1: STS, 2: STS})
    backend = robot(wires, [mount(STS, "body", 1), mount(STS, "body", 2)])
    backend.connect()
    backend.configure()
    serial, speed = wires["body"], STS.motor(7.4).no_load_speed
    believed, when = 0.0, backend.clock.now()
    for place, flip in flips:

        def forge(id: int, frame: bytes, place: int = place, flip: int = flip) -> bytes:
            if id != 2 or len(frame) < 12:
                return frame
            params = bytearray(frame[5:-1])
            params[place] ^= flip
            return protocol1.status(id, bytes(params))

        serial.spoil = forge
        ticks(backend, 1)
        state = backend.read().joints
        now = backend.clock.now()
        # 2 % of the range, and 1.5 times what the servo can do since it was last believed.
        assert abs(state.position[1] - believed) <= 0.02 * 2 * pi + 1.5 * speed * (now - when)
        if state.position[1] != believed or state.age[1] == 0.0:
            believed, when = state.position[1], now - state.age[1]
        assert state.position[0] == 0.0


def test_a_forged_jump_is_counted_and_the_joint_coasts_with_its_age() -> None:
    wires = Wires()
    wires.add("head", {1: SCS, 2: SCS})
    backend = robot(wires, [mount(SCS, "head", 1), mount(SCS, "head", 2)])
    backend.connect()
    backend.configure()
    serial = wires["head"]
    serial.set(2, "present_position", 1000)
    ticks(backend, 1)
    state = backend.read().joints
    assert state.position.tolist() == [0.0, 0.0]
    assert state.age[0] == 0.0 and state.age[1] > 0.005
    assert backend.readouts[0].bus.exchange.errors["implausible"] == 2
    serial.set(2, "present_position", 512)
    ticks(backend, 1)
    assert backend.read().joints.age.tolist() == [0.0, 0.0]
