"""How to test a program for servos without servos: the fixtures that Windup installs.

Run it with `pytest docs/test_servo_bus_example.py`. Time is virtual: nothing here waits, and every
run brings the same bytes.
"""

from pathlib import Path

import numpy as np
import pytest

from windup.hal.errors import StaleStateError


def test_a_robot_stands_although_its_bus_is_bad(servo_bus):
    bus = servo_bus("op3", physics="mujoco", seed=1)
    bus.faults.drop(ids=[7], rate=0.02).delay(0.016).corrupt(rate=0.001)
    robot = bus.robot()  # the real driver and controller, on emulated bytes
    robot.stand(2.0)
    assert not robot.fallen and robot.loop.missed == 0
    assert bus.faults.counts["delay"] > 0


def test_a_dead_knee_is_named(servo_bus):
    bus = servo_bus("op3", seed=1)
    bus.faults.dead(ids=[13], at=1.5)
    robot = bus.robot()
    with pytest.raises(StaleStateError, match="r_knee"):
        robot.stand(4.0)
    assert not any(device.driving for device in bus.world.devices)  # it let go


def test_any_serial_program_can_speak_to_the_bus(servo_bus):
    bus = servo_bus("bench", servos="STS3215:1-3")
    with bus.serial() as port:  # a pyserial port
        port.write(bytes.fromhex("FF FF 02 02 01 FA"))  # ping servo 2
        assert port.read(6) == bytes.fromhex("FF FF 02 02 00 FB")


def test_servos_can_be_looked_into(servo_bus):
    bus = servo_bus("bench", servos="XL430-W250:1", return_delay=0)
    bus.servo(1).set_supply(5.0, 0.0)
    bus.wait(0.1)
    with bus.serial() as port:
        port.write(bytes.fromhex("FF FF FD 00 01 03 00 01 19 4E"))
        status = port.read(14)
    assert status[8] & 0x80  # the alert bit: 5 V is too little


def test_a_wizard_that_records_ranges_finds_one(servo_bus):
    bus = servo_bus("bench", servos="STS3215:1")
    bus.hand("1", degrees=90, seconds=2)  # turns the limp shaft to and fro
    seen = []
    with bus.serial() as port:
        for _ in range(50):
            bus.wait(0.05)
            port.write(bytes.fromhex("FF FF 01 04 02 38 02 BE"))  # present position
            seen.append(int.from_bytes(port.read(8)[5:7], "little"))
    assert max(seen) - min(seen) > 1000  # of 1024


def test_the_bytes_are_the_same_as_last_time(servo_bus, servo_replay, tmp_path: Path):
    def talk(bus):
        with bus.serial() as port:
            port.write(bytes.fromhex("FF FF FE 07 82 38 02 01 02 03 36"))  # sync read
            return np.frombuffer(port.read(24), np.uint8)

    trace = tmp_path / "golden.trace"  # keep yours beside the test
    bus = servo_bus("bench", servos="STS3215:1-3")
    bus.golden(trace)  # recorded if it is not there, else compared with
    first = talk(bus)
    bus.close()

    tape = servo_replay(trace)  # no servos, no physics: the trace answers
    assert np.array_equal(talk(tape), first)
