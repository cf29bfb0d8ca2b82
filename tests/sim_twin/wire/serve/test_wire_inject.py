"""Faults that are injected into an emulator while it serves, in real time. Nothing is timed."""

import time
from contextlib import closing
from pathlib import Path

import pytest
import serial

from tests.sim_twin.wire.emulator_process import run_emulator
from windup.hal.errors import UsageError
from windup.sim_twin.wire import build_world, parse_address
from windup.sim_twin.wire.protocols.frames import encode
from windup.sim_twin.wire.serve.emulate import Emulator

BUS = "twin://bench?servos=XM430-W350:1-2&return_delay=0"
PING = encode(1, 1)
TORQUE_ON = encode(254, 3, bytes((64, 0, 1)))
PATIENCE = 20.0  # s for the machine


def answers(name: str) -> bool:
    """Whether a servo can be reached; a busy machine gets a few goes."""
    with serial.serial_for_url(name, baudrate=1_000_000, timeout=1.0) as port:
        port.write(PING)
        return len(port.read(14)) == 14


def wait_for_answer(name: str) -> None:
    deadline = time.monotonic() + PATIENCE
    while not answers(name):
        assert time.monotonic() < deadline


@pytest.mark.parametrize("kind", ["pty", "tcp"])
def test_an_adapter_is_pulled_out_and_its_name_can_be_opened_again(
    tmp_path: Path, kind: str
) -> None:
    pty = tmp_path / "bus" if kind == "pty" else None
    with run_emulator(BUS, pty) as emulator:
        wait_for_answer(emulator.name)
        with serial.serial_for_url(emulator.name, timeout=PATIENCE) as port:
            emulator.inject("unplug:seconds=0.2")
            assert emulator.next_event() == "unplugged 0 bench"
            with pytest.raises(serial.SerialException):
                port.read(1)
        assert emulator.next_event() == "plugged 1 bench"
        wait_for_answer(emulator.name)


def test_driven_motors_and_the_supply_are_told(tmp_path: Path) -> None:
    with run_emulator(BUS, tmp_path / "bus") as emulator:
        with serial.serial_for_url(emulator.name, baudrate=1_000_000) as port:
            port.write(TORQUE_ON)
            assert emulator.next_event() == "driven 2"
        emulator.inject("brown_out:volts=0:seconds=0.2")
        told = {emulator.next_event() for _ in range(3)}
        assert told == {"supply 0.0", "driven 0", "supply 12.0"}


def test_times_count_from_the_order_and_orders_come_one_after_the_other(tmp_path: Path) -> None:
    with run_emulator(BUS, tmp_path / "bus") as emulator:
        emulator.inject("brown_out:volts=8:at=0.1:seconds=inf")
        emulator.inject("brown_out:volts=6:at=0.3:seconds=inf")
        assert emulator.next_event() == "supply 8.0"
        assert emulator.next_event() == "supply 6.0"


@pytest.mark.parametrize(
    ("text", "message"),
    [("unplg", "unknown kind 'unplg'"), ("reset:ids=9", "no servo has id 9"), ("button", "OpenCR")],
)
def test_what_cannot_happen_is_said_to_who_orders_it(text: str, message: str) -> None:
    with (
        closing(Emulator(build_world(parse_address(BUS)))) as emulator,
        pytest.raises(UsageError, match=message),
    ):
        emulator.inject(text)


def test_nothing_can_be_injected_after_the_end() -> None:
    with closing(Emulator(build_world(parse_address(BUS)))) as emulator:
        emulator.stop()
        with pytest.raises(UsageError, match="has ended"):
            emulator.inject("reset")
