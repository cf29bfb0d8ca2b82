"""Nothing but torque that was read as off ends a guardian that stops a robot."""

import os
import signal
from contextlib import suppress
from math import inf
from pathlib import Path

import msgspec
import pytest

from tests.hal.guardian.two_servos import (
    NAMES,
    TORQUE,
    full_pipe,
    host,
    record,
    runs,
    show,
    switch_on,
    wait_for_end,
)
from windup.hal.guardian import takeover
from windup.hal.guardian.order import GuardianOrder
from windup.hal.guardian.remote_bus import RemoteBus
from windup.hal.guardian.takeover import Takeover


def order(path: Path, policy: str = "limp") -> GuardianOrder:
    whole = msgspec.structs.replace(record(path), names=NAMES, crouch={1: 1800, 2: 2300})
    return GuardianOrder(host=os.getpid(), policy=policy, buses=(whole,))  # type: ignore[arg-type]


def fails(*_: object) -> None:
    raise AttributeError("a bug")


def test_a_host_whose_standard_error_is_closed_is_stopped(sts_bus: Path) -> None:
    with host(sts_bus, "limp", errors=None) as (program, guardian):
        program.kill()
        wait_for_end(guardian)
    assert show(sts_bus, TORQUE) == [0, 0]


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_a_host_whose_standard_error_nobody_reads_is_stopped(sts_bus: Path, number: int) -> None:
    with full_pipe() as errors, host(sts_bus, "limp", errors=errors) as (program, guardian):
        os.kill(program.pid, number)
        assert program.wait() == -signal.SIGKILL
        wait_for_end(guardian)
    assert show(sts_bus, TORQUE) == [0, 0]


@pytest.mark.parametrize("policy", ["hold", "crouch"])
def test_a_policy_that_fails_in_any_way_ends_with_torque_off(
    sts_bus: Path, monkeypatch: pytest.MonkeyPatch, policy: str
) -> None:
    monkeypatch.setattr(takeover, policy, fails)
    switch_on(sts_bus)
    said: list[str] = []
    Takeover(order(sts_bus, policy), said.append).carry_out("the program died")
    assert f"cannot {policy} (AttributeError: a bug); torque goes off" in said
    assert show(sts_bus, TORQUE) == [0, 0]


def test_whoever_cannot_speak_switches_off(sts_bus: Path) -> None:
    switch_on(sts_bus)
    Takeover(order(sts_bus, "crouch"), fails).carry_out("the program died")
    assert show(sts_bus, TORQUE) == [0, 0]


def test_a_bus_that_fails_in_any_way_is_tried_until_it_does_not(
    sts_bus: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    torque, left = RemoteBus.torque, [AttributeError("a bug"), OSError(24, "x"), MemoryError()]

    def fails_at_first(bus: RemoteBus) -> object:
        if left:
            raise left.pop()
        return torque(bus)

    switch_on(sts_bus)
    monkeypatch.setattr(RemoteBus, "torque", fails_at_first)
    Takeover(order(sts_bus), print).carry_out("the program died")
    assert not left
    monkeypatch.undo()
    assert show(sts_bus, TORQUE) == [0, 0]


def test_a_guardian_that_cannot_hear_its_host_ends_it_and_stops_the_servos(
    sts_bus: Path,
) -> None:
    """A byte that is no heartbeat is a bug, and one that must not leave the robot alone."""
    with host(sts_bus, "limp") as (program, guardian):
        with Path(f"/proc/{guardian}/fd/0").open("wb", buffering=0) as ours:
            while runs(guardian):
                with suppress(BrokenPipeError):
                    ours.write(b"?")
        assert program.stderr is not None
        assert "the guardian failed to read the heartbeats" in program.stderr.read()
        assert program.wait() == -signal.SIGKILL
    assert show(sts_bus, TORQUE) == [0, 0]


def test_joints_are_called_by_their_names_and_who_cuts_the_power_is_told_how_to_end(
    sts_bus: Path,
) -> None:
    switch_on(sts_bus)
    lost = msgspec.structs.replace(
        record(sts_bus), servos={**record(sts_bus).servos, 9: "STS3215-7.4V"},
        names={**NAMES, 9: "neck"},
    )  # fmt: skip
    said: list[str] = []
    taken = Takeover(GuardianOrder(host=1, policy="limp", buses=(lost,)), said.append)
    assert taken.switch_off_once() == [str(sts_bus)]
    taken._report_trouble(inf)
    assert "torque cannot be read at neck (id 9)" in said[0]
    assert said[0].endswith(f"; cut the servo power, then end this process: kill -9 {os.getpid()}")
