"""A guardian and its host against an emulated bus in a process of its own."""

import os
import signal
from pathlib import Path

import msgspec
import pytest

from tests.hal.guardian.two_servos import (
    GOAL,
    NAMES,
    TORQUE,
    host,
    record,
    runs,
    show,
    switch_on,
    wait_for_end,
)
from windup.hal.errors import UnknownNameError
from windup.hal.guardian.handle import Guardian
from windup.hal.guardian.host import Host
from windup.hal.guardian.order import GuardedBus, GuardianOrder
from windup.hal.guardian.takeover import Takeover


def test_the_servos_of_a_host_that_was_killed_go_off(sts_bus: Path) -> None:
    with host(sts_bus, "limp") as (program, guardian):
        program.kill()
        wait_for_end(guardian)
    assert show(sts_bus, TORQUE) == [0, 0]


def test_a_host_that_hangs_says_where_is_killed_and_its_servos_go_off(sts_bus: Path) -> None:
    with host(sts_bus, "limp") as (program, guardian):
        os.kill(program.pid, signal.SIGSTOP)
        wait_for_end(guardian)
        assert program.wait() == -signal.SIGKILL
        assert program.stderr is not None
        assert "the program hangs" in program.stderr.read()
    assert show(sts_bus, TORQUE) == [0, 0]


def test_a_robot_whose_policy_is_a_crouch_crouches_before_it_goes_off(sts_bus: Path) -> None:
    with host(sts_bus, "crouch") as (program, guardian):
        program.kill()
        wait_for_end(guardian)
    assert show(sts_bus, TORQUE) == [0, 0]
    assert show(sts_bus, GOAL) == pytest.approx([1800, 2300], abs=20)


def test_a_robot_that_shall_hold_is_held_for_its_time_and_goes_off_then(sts_bus: Path) -> None:
    with host(sts_bus, "hold", 1.0) as (program, guardian):
        program.kill()
        program.wait()
        assert program.stderr is not None
        for line in program.stderr:
            if "holds its pose" in line:
                break
        assert show(sts_bus, TORQUE) == [1, 1]
        wait_for_end(guardian)
    assert show(sts_bus, TORQUE) == [0, 0]


@pytest.mark.parametrize(
    ("levels", "why"), [((20.0, 0.0), "is too hot"), ((70.0, 99.0), "is short of supply")]
)
def test_a_servo_beyond_the_stop_levels_of_its_robot_is_not_held(
    sts_bus: Path, capfd: pytest.CaptureFixture[str], levels: tuple[float, float], why: str
) -> None:
    guardian = Guardian(
        [msgspec.structs.replace(record(sts_bus), levels={2: levels}, names=NAMES)],
        "hold",
        60.0,
    )
    switch_on(sts_bus)
    guardian.hand_over()
    guardian._process.wait()
    assert f"r_knee (id 2) {why}" in capfd.readouterr().err
    assert show(sts_bus, TORQUE) == [0, 0]


def test_a_host_that_gives_up_its_ports_lives_on_and_its_servos_go_off(sts_bus: Path) -> None:
    guardian = Guardian([record(sts_bus)], "limp")
    switch_on(sts_bus)
    guardian.hand_over()
    guardian._process.wait()
    assert show(sts_bus, TORQUE) == [0, 0]


def test_a_port_that_is_not_there_is_tried_until_it_is(sts_bus: Path, tmp_path: Path) -> None:
    later = tmp_path / "later"
    switch_on(sts_bus)
    guardian = Guardian([record(later)], "limp")
    guardian.hand_over()
    assert runs(guardian.pid)
    later.symlink_to(sts_bus)
    guardian._process.wait()
    assert show(sts_bus, TORQUE) == [0, 0]


def test_a_bus_that_stays_away_does_not_keep_another_from_its_stop(
    sts_bus: Path, tmp_path: Path
) -> None:
    switch_on(sts_bus)
    order = GuardianOrder(
        host=os.getpid(), policy="limp", buses=(record(tmp_path / "no"), record(sts_bus))
    )
    takeover = Takeover(order, print)
    assert takeover.switch_off_once() == [str(tmp_path / "no")]
    assert show(sts_bus, TORQUE) == [0, 0]


def test_a_host_that_has_been_gone_for_long_is_known_to_be_gone() -> None:
    child = os.fork()
    if child == 0:
        os._exit(0)
    os.waitpid(child, 0)
    assert Host(child).has_ended and not Host(os.getpid()).has_ended


def test_servos_that_nobody_knows_are_refused_before_torque() -> None:
    strange = GuardedBus(url="x", baud=1, servos={1: "XX"})
    with pytest.raises(UnknownNameError, match="servo"):
        Takeover(GuardianOrder(host=1, policy="limp", buses=(strange,)), print)
