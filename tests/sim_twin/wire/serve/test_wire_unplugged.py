"""An unplugged adapter raises the same from a virtual port as from a terminal that hung up."""

import os
import termios
from collections.abc import Callable
from contextlib import closing
from typing import Any

import pytest
import serial

from windup.hal.errors import PortError
from windup.hal.port.port import GONE, Port
from windup.tools.testing.servo_bus import ServoBus


def set_baud(port: Any) -> None:
    port.baudrate = 115_200


def set_timeout(port: Any) -> None:
    port.timeout = 0.2


CALLS: dict[str, Callable[[Any], object]] = {
    "in_waiting": lambda port: port.in_waiting,
    "flush": lambda port: port.flush(),
    "reset_input_buffer": lambda port: port.reset_input_buffer(),
    "reset_output_buffer": lambda port: port.reset_output_buffer(),
    "baudrate": set_baud,
    "timeout": set_timeout,
    "read": lambda port: port.read(1),
    "write": lambda port: port.write(b"x"),
}
TERMIOS = {"flush", "reset_input_buffer", "reset_output_buffer"}


def raised(port: Any, call: str) -> Exception:
    with pytest.raises(GONE) as caught:
        CALLS[call](port)
    return caught.value


def on_a_terminal(call: str) -> Exception:
    master, slave = os.openpty()
    port = serial.Serial(os.ttyname(slave), 1_000_000, timeout=0.1)
    os.close(master)
    os.close(slave)
    with closing(port):
        return raised(port, call)


@pytest.mark.parametrize("call", CALLS)
def test_each_call_raises_what_it_raises_on_a_terminal(call: str) -> None:
    with ServoBus(servos="STS3215:1") as bus, bus.serial() as port:
        bus.faults.unplug(seconds=0.5)  # now: the next call finds it unplugged
        error = raised(port, call)
        expected = on_a_terminal(call)
        assert type(error) is type(expected)
        if not isinstance(expected, serial.SerialException):
            assert error.args == expected.args == (5, "Input/output error")
        assert isinstance(error, termios.error) == (call in TERMIOS)
        bus.wait(0.6)
        with bus.serial() as again:
            assert again.in_waiting == 0


DISCONNECTED = r"was disconnected \([^(]*\); check cable"
DRIVER_CALLS: dict[str, Callable[[Port], object]] = {
    "read": lambda port: port.read(1, port.clock.now() + 0.01),
    "write": lambda port: port.write(b"x"),
    "flush_input": lambda port: port.flush_input(),
    "drain_input": lambda port: port.drain_input(0.01, 0.1),
    "baud": lambda port: setattr(port, "baud", 115_200),
}


@pytest.mark.parametrize("call", DRIVER_CALLS)
def test_our_driver_makes_one_error_of_all_of_them(call: str) -> None:
    with ServoBus(servos="STS3215:1") as bus, bus.port() as port:
        bus.faults.unplug(seconds=0.5)
        with pytest.raises(PortError, match=DISCONNECTED if call != "baud" else "unplugged"):
            DRIVER_CALLS[call](port)


def test_a_port_cannot_be_opened_right_after_its_adapter_is_unplugged() -> None:
    with ServoBus(servos="STS3215:1") as bus:
        bus.faults.unplug(seconds=0.5)
        with pytest.raises(serial.SerialException, match="is unplugged"):
            bus.serial()
        with pytest.raises(PortError, match="is unplugged"):
            bus.port()
