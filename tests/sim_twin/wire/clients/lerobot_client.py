"""A script of somebody who has LeRobot and three servos: ``sts|x|setup-sts|setup-x PORT``.

Makes every call of the bus class and prints what it found as JSON. Hands turn the motors a and b
while they are limp.
"""

import json
import os
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

import dynamixel_sdk
from lerobot.motors import Motor, MotorNormMode, feetech
from lerobot.motors.dynamixel import DynamixelMotorsBus
from lerobot.motors.feetech import FeetechMotorsBus

from tests.sim_twin.wire.clients.record import calls, recorded

MODES = {
    "a": MotorNormMode.RANGE_M100_100,
    "b": MotorNormMode.RANGE_0_100,
    "c": MotorNormMode.DEGREES,
}
PATIENCE = 1000  # ms, for a busy machine
RECORDING = 1.1  # s; a hand needs 1.0 s there and back
SWING = 440  # counts that a hand turns a motor, nearly
BUSES = {"sts": (FeetechMotorsBus, "sts3215"), "x": (DynamixelMotorsBus, "xl330-m288")}
FIRST: dict[str, dict[str, int]] = {"sts": {}, "x": {"initial_baudrate": 57_600}}
GAIN = {"sts": ("P_Coefficient", 16), "x": ("Position_P_Gain", 300)}


def motors(model: str) -> dict[str, Any]:
    return {name: Motor(k, model, mode) for k, (name, mode) in enumerate(MODES.items(), start=1)}


def be_patient() -> None:
    """Let the SDKs wait longer for an answer than 50 and 34 ms."""

    def wait(port: Any, _: int) -> None:
        port.setPacketTimeoutMillis(PATIENCE)

    feetech.feetech.patch_setPacketTimeout = wait
    dynamixel_sdk.port_handler.LATENCY_TIMER = PATIENCE / 2


def until(ask: Callable[[], Any], good: Callable[[Any], bool]) -> Any:
    """Ask until the answer is good, or a busy machine has had its time."""
    end = time.monotonic() + 30.0
    while not good(answer := ask()) and time.monotonic() < end:
        pass
    return answer


def record(bus: Any) -> tuple[dict[str, int], dict[str, int]]:
    """Record the ranges of motion until somebody presses enter."""
    reader, writer = os.pipe()
    sys.stdin = os.fdopen(reader)
    threading.Timer(RECORDING, os.write, (writer, b"\n")).start()
    mins, maxes = bus.record_ranges_of_motion(["a", "b"])
    return mins, maxes


def find(bus: Any) -> dict[str, Any]:
    """Find the motors, and set them up."""
    said: dict[str, Any] = {"scan": bus.scan_port(bus.port)}
    bus.connect()
    said["connected"], said["ids"], said["models"] = bus.is_connected, bus.ids, bus.models
    said["pings"] = [bus.ping(name) for name in MODES]
    said["all"] = until(bus.broadcast_ping, lambda found: found is not None and len(found) == 3)
    bus.set_baudrate(1_000_000)
    said["baud"] = bus.get_baudrate()
    bus.set_timeout(PATIENCE)
    bus.disable_torque()
    bus.configure_motors()
    said["delay"] = [bus.read("Return_Delay_Time", name) for name in MODES]
    return said


def calibrate(bus: Any) -> dict[str, Any]:
    """Make the middle of where the motors are, and record how far hands turn them."""
    said: dict[str, Any] = {"offsets": bus.set_half_turn_homings()}
    said["middle"] = bus.sync_read("Present_Position", normalize=False)
    said["mins"], said["maxes"] = until(
        lambda: record(bus), lambda got: all(got[1][name] - got[0][name] > SWING for name in "ab")
    )
    made = bus.read_calibration()
    said["made"] = {name: one.homing_offset for name, one in made.items()}
    for one in made.values():
        one.range_min, one.range_max = 1000, 3000
    bus.write_calibration(made, cache=False)
    said["before"] = bus.is_calibrated
    bus.write_calibration(made)
    said["after"] = bus.is_calibrated
    return said


def drive(bus: Any, gain: str, value: int) -> dict[str, Any]:
    """Switch the torque, and go to goals in the units of each motor."""
    bus.write(gain, "a", value)
    said: dict[str, Any] = {"gain": bus.read(gain, "a")}
    bus.enable_torque()
    goals = {"a": -50.0, "b": 75.0, "c": 20.0}
    bus.sync_write("Goal_Position", goals)
    said["reached"] = until(
        lambda: bus.sync_read("Present_Position"),
        lambda at: all(abs(at[name] - goal) < 3.0 for name, goal in goals.items()),
    )
    bus.write("Goal_Position", "c", -20.0)
    said["alone"] = until(lambda: bus.read("Present_Position", "c"), lambda at: abs(at + 20) < 3.0)
    with bus.torque_disabled(["a", "b"]):
        said["limp"] = bus.sync_read("Torque_Enable")
    said["held"] = bus.sync_read("Torque_Enable")
    bus.disable_torque("c")
    bus.reset_calibration("c")
    ends = ("Min_Position_Limit", "Max_Position_Limit")
    said["reset"] = [bus.read(end, "c", normalize=False) for end in ends]
    bus.disconnect()
    said["left"] = bus.is_connected
    return said


def everything(family: str, path: str) -> dict[str, Any]:
    original, model = BUSES[family]
    kind, asked = recorded(original)
    kind.available_baudrates = [1_000_000]  # each takes LeRobot a second
    bus = kind(path, motors(model))
    said = {**find(bus), **calibrate(bus), **drive(bus, *GAIN[family])}
    return {**said, "uncalled": sorted(calls(original) - asked)}


def set_up(family: str, path: str) -> dict[str, Any]:
    """Give the only motor on the bus its id and LeRobot's baud rate."""
    kind, model = BUSES[family]
    bus = kind(path, {"d": Motor(9, model, MotorNormMode.DEGREES)})
    bus.setup_motor("d", **FIRST[family])
    said = {"renamed": bus.ping("d"), "baud": bus.get_baudrate(), "old": bus.ping(1)}
    bus.disconnect()
    return said


def main(what: str, path: str) -> None:
    be_patient()
    job, _, family = what.rpartition("-")
    print(json.dumps(set_up(family, path) if job else everything(family, path)))


if __name__ == "__main__":
    main(*sys.argv[1:])
