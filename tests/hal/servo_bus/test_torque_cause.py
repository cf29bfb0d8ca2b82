"""What the registers of a servo say of its torque, as a table."""

from math import nan

import pytest

from windup.hal.families import DYNAMIXEL_1, DYNAMIXEL_X, FEETECH_SCS, FEETECH_STS, Family
from windup.hal.servo_bus.torque_cause import Evidence, torque_loss_of
from windup.hal.torque_loss import UNPLUGGED, Loss, restart_loss, torque_lost

HOT, LOADED = 0b100, 0b10_0000
ALL = [DYNAMIXEL_X, DYNAMIXEL_1, FEETECH_STS, FEETECH_SCS]
names = [family.name for family in ALL]


def cause(family: Family, **known: int) -> str:
    seen = {"torque_on": False, "restarted": False, "errors": 0, "unloading": HOT | LOADED, **known}
    return str(torque_loss_of(family, Evidence(**seen), nan))  # type: ignore[arg-type]


@pytest.mark.parametrize("family", ALL, ids=names)
def test_an_alert_of_a_servo_that_drives_is_no_loss(family: Family) -> None:
    assert cause(family, torque_on=True, errors=HOT) == "None"
    assert cause(family, torque_on=True, errors=LOADED, unloading=HOT) == "None"


@pytest.mark.parametrize("family", ALL, ids=names)
def test_a_servo_that_signals_what_ends_its_torque_has_shut_down(family: Family) -> None:
    assert cause(family, errors=HOT) == "its servo shut down: overheating"


@pytest.mark.parametrize("family", ALL, ids=names)
def test_a_restart_comes_before_all_other_causes(family: Family) -> None:
    assert cause(family, restarted=True, errors=HOT) == "its servo restarted"
    assert cause(family, restarted=True, torque_on=True) == "its servo restarted"


@pytest.mark.parametrize(
    ("family", "said"),
    [
        (DYNAMIXEL_X, "another program switched it off"),
        (DYNAMIXEL_1, "another program switched it off"),
        (FEETECH_STS, "its servo or another program switched it off"),
        (FEETECH_SCS, "its servo or another program switched it off"),
    ],
)
def test_without_an_error_it_was_somebody_where_errors_stay_until_the_power_goes(
    family: Family, said: str
) -> None:
    assert cause(family, errors=0) == said
    assert cause(family, errors=HOT, unloading=0) == said


@pytest.mark.parametrize("family", [FEETECH_STS, FEETECH_SCS])
def test_an_overload_of_a_feetech_servo_leaves_a_part_of_its_torque(family: Family) -> None:
    weak = "its servo has reduced its torque: overload"
    assert cause(family, torque_on=True, errors=LOADED) == weak


def test_one_sentence_for_each_cause_names_the_joints_and_what_to_do() -> None:
    dip = restart_loss(6.1)
    error = torque_lost({"knee": dip, "hip": UNPLUGGED, "ankle": dip, "toe": Loss("why", "do")})
    assert error.exit_status == 3
    assert str(error).split("; ") == [
        "knee, ankle lost their torque: their servos restarted "
        "(lowest supply that was read: 6.1 V)",
        "check battery, supply and connectors, then start again",
        "hip lost its torque: the port was disconnected, "
        "and torque was switched off when it came back",
        "check the cable of the adapter, then start again",
        "toe lost its torque: why",
        "do",
    ]
