"""Mistakes in a call of `servo_bus` or of its faults: one line that says what would be right."""

import math

import pytest

from windup.hal.errors import UnknownNameError, UsageError
from windup.tools.testing.servo_bus import ServoBus
from windup.tools.testing.servo_pty import ServoPty


def test_a_fault_of_no_servo_is_refused_and_not_added() -> None:
    with ServoBus(servos="STS3215:1-3") as bus:
        with pytest.raises(UsageError, match="no servo has id 9; ids here: 1, 2, 3"):
            bus.faults.overload(ids=[9])
        with pytest.raises(UsageError, match="no servo has id 9; ids here: 1, 2, 3"):
            bus.faults.drop(ids=9, rate=0.5)
        with pytest.raises(UsageError, match="there is no IMU in this world"):
            bus.faults.imu_silent()
        assert not bus.faults.active


def test_one_id_need_not_be_a_list() -> None:
    with ServoBus(servos="STS3215:1-3") as bus:
        bus.faults.dead(ids=2)
        bus.wait(0.01)
        assert bus.world.dead == [bus.servo(2)]


def test_a_robot_has_its_own_servos() -> None:
    with pytest.raises(UsageError, match="robot 'op3' has its own: give one of the two"):
        ServoBus("op3", servos="STS3215:1-3")
    with pytest.raises(UsageError, match="robot 'op3' has its own: give one of the two"):
        ServoPty("op3", servos="STS3215:1-3")


def test_servos_that_are_given_as_a_robot() -> None:
    with pytest.raises(UsageError, match='are given as servos="STS3215:1-3"'):
        ServoBus("STS3215:1-3")


def test_models_are_found_in_upper_and_lower_case_and_suggested_by_their_short_names() -> None:
    with ServoBus(servos="sts3215:1,Sts3215-12v:2") as bus:
        assert len(bus.world.devices) == 2
    with pytest.raises(UnknownNameError, match="did you mean 'STS3215'"):
        ServoBus(servos="st3215:1")


@pytest.mark.parametrize("seconds", [-1.0, math.nan, math.inf])
def test_time_passes_forwards_and_ends(seconds: float) -> None:
    with ServoBus(servos="STS3215:1") as bus:
        with pytest.raises(UsageError, match=r"wait .*: give"):
            bus.wait(seconds)
        assert bus.clock.now() == 0.0
