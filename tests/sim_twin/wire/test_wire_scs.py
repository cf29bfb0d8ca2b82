"""What sets an SCS servo apart from an STS, over the wire, on the virtual clock."""

from collections.abc import Iterator

import pytest

from tests.sim_twin.wire.wire_host1 import READ, REBOOT, WRITE, Host1, open_host1

SCS = 9


@pytest.fixture
def scs() -> Iterator[Host1]:
    with open_host1("twin://bench?servos=SCS0009:9") as host:
        yield host


def test_an_scs_has_the_high_byte_first_and_1024_steps(scs: Host1) -> None:
    assert scs.ask(SCS, READ, bytes((3, 2)))[0].parameters == bytes((5, 4))
    scs.place(SCS, 300)
    assert scs.ask(SCS, READ, bytes((56, 2)))[0].parameters == (300).to_bytes(2, "big")
    scs.ask(SCS, WRITE, bytes((42,)) + (700).to_bytes(2, "big"))
    scs.wait(1.5)
    assert scs.read(SCS, "present_position") == pytest.approx(700, abs=4)
    assert scs.shaft(SCS).position == pytest.approx((700 - 512) * 300 / 1024 / 57.2958, abs=0.02)


def test_an_scs_takes_the_time_it_is_told(scs: Host1) -> None:
    goal = (612).to_bytes(2, "big") + (2000).to_bytes(2, "big")
    scs.ask(SCS, WRITE, bytes((42,)) + goal)
    scs.wait(1.0)
    assert scs.read(SCS, "present_position") == pytest.approx(562, abs=6)


def test_an_scs_with_a_speed_ignores_the_time(scs: Host1) -> None:
    goal = b"".join(k.to_bytes(2, "big") for k in (712, 4000, 200))
    scs.ask(SCS, WRITE, bytes((42,)) + goal)
    scs.wait(0.5)
    assert scs.read(SCS, "present_position") == pytest.approx(612, abs=8)
    scs.wait(1.0)
    assert scs.read(SCS, "present_position") == pytest.approx(712, abs=4)


def test_an_scs_lock_is_at_48(scs: Host1) -> None:
    scs.ask(SCS, WRITE, bytes((48, 0)))
    scs.write(SCS, "p_gain", 9)
    scs.ask(SCS, REBOOT)
    scs.wait(0.5)
    assert scs.read(SCS, "p_gain") == 9


def test_an_scs_without_angle_limits_is_a_wheel(scs: Host1) -> None:
    scs.write(SCS, "min_angle", 0)
    scs.write(SCS, "max_angle", 0)
    scs.ask(SCS, WRITE, bytes((44,)) + (500 | 1 << 10).to_bytes(2, "big"))
    scs.wait(0.5)
    assert scs.shaft(SCS).velocity < -3.0
    assert scs.read(SCS, "present_speed") < -500
