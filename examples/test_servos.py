"""Test a program that speaks to servos, without servos: `pytest examples/test_servos.py`.

`read_position` stands for your own code. The fixture `servo_bus` comes with Windup; time is
virtual, so nothing here waits, and every run gives the same bytes.
"""

from typing import Any

import pytest

COUNTS = 4096


class ServoSilentError(Exception):
    """A servo did not answer."""


def read_position(port: Any, servo: int) -> int:
    """Return the position of an STS3215 in counts: three tries, then give up.

    Raises:
        ServoSilentError: No answer to any of them.
    """
    body = bytes([servo, 4, 0x02, 56, 2])
    request = b"\xff\xff" + body + bytes([~sum(body) & 0xFF])
    for _ in range(3):
        port.reset_input_buffer()
        port.write(request)
        answer = port.read(8)
        if len(answer) == 8 and answer[2] == servo and ~sum(answer[2:7]) & 0xFF == answer[7]:
            return int.from_bytes(answer[5:7], "little")
    raise ServoSilentError(f"servo {servo} does not answer")


def test_it_reads_a_position(servo_bus):
    bus = servo_bus(servos="STS3215:1-3")
    with bus.serial() as port:
        assert read_position(port, 2) == pytest.approx(COUNTS // 2, abs=2)


def test_it_tries_again_where_answers_are_lost(servo_bus):
    bus = servo_bus(servos="STS3215:1-3", seed=1)
    bus.faults.drop(rate=0.2).corrupt(rate=0.1)
    with bus.serial() as port:
        for servo in (1, 2, 3) * 5:
            assert read_position(port, servo) == pytest.approx(COUNTS // 2, abs=2)
    assert bus.faults.counts["drop"] > 0 and bus.faults.counts["corrupt"] > 0


def test_it_names_the_servo_that_is_dead(servo_bus):
    bus = servo_bus(servos="STS3215:1-3")
    bus.faults.dead(ids=[3])  # now
    with bus.serial() as port, pytest.raises(ServoSilentError, match="servo 3"):
        read_position(port, 3)
