"""What offset, register 44 and lock of an STS mean in each mode, as its memory table has it."""

from collections.abc import Iterator

import pytest

from tests.sim_twin.wire.wire_host1 import PING, WRITE, Host1, open_host1

SPEED, PWM, STEP = 1, 2, 3


@pytest.fixture
def host() -> Iterator[Host1]:
    with open_host1("twin://bench?servos=STS3215-12V:1-2") as host:
        yield host


@pytest.mark.parametrize("mode", [SPEED, PWM, STEP])
def test_the_offset_counts_in_position_mode_only(host: Host1, mode: int) -> None:
    host.write(1, "offset", 85)
    assert host.read(1, "present_position") == 2048 - 85
    host.write(1, "mode", mode)
    assert host.read(1, "present_position") == 2048
    host.write(1, "mode", 0)
    assert host.read(1, "present_position") == 2048 - 85


def test_bit_10_of_register_44_turns_pwm_mode_round(host: Host1) -> None:
    for servo, word in ((1, 300), (2, 300 | 1 << 10)):
        host.write(servo, "mode", PWM)
        host.ask(servo, WRITE, bytes((44,)) + word.to_bytes(2, "little"))
    host.wait(0.5)
    assert host.read(1, "present_speed") > 100
    assert host.read(2, "present_speed") < -100


def test_register_44_does_nothing_in_position_mode(host: Host1) -> None:
    host.place(1, 1000)
    host.ask(1, WRITE, bytes((42,)) + bytes.fromhex("D007 E803 F401"))  # 2000, 1000, 500 steps/s
    host.wait(1.5)
    assert host.read(1, "present_speed") == pytest.approx(500, abs=5)
    host.wait(1.0)
    assert host.read(1, "present_position") == pytest.approx(2000, abs=3)


def test_with_the_lock_on_an_id_lasts_until_the_power_goes(host: Host1) -> None:
    assert len(host.ask(1, WRITE, bytes((5, 7)))) == 1
    assert len(host.ask(7, PING)) == 1
    host.world.set_supply(0.0)
    host.world.set_supply(12.0)
    host.wait(0.5)
    assert (host.ask(7, PING), len(host.ask(1, PING))) == ([], 1)
