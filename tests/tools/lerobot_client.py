"""A script of somebody who has LeRobot and three STS3215: ``lerobot_client.py PORT``.

Prints what it found as JSON. LeRobot's motors need no torch; its other parts import it, and much
more, so what is missing is stubbed.
"""

import importlib
import json
import os
import sys
import threading
import time
from typing import Any
from unittest.mock import MagicMock

for name in ("torch", "accelerate", "datasets", "datasets.utils", "datasets.utils.logging"):
    try:
        importlib.import_module(name)
    except ImportError:
        sys.modules[name] = MagicMock()

from lerobot.motors import Motor, MotorCalibration, MotorNormMode  # noqa: E402 - stubs come first
from lerobot.motors.feetech import FeetechMotorsBus  # noqa: E402

MOTORS = {
    "a": Motor(1, "sts3215", MotorNormMode.RANGE_M100_100),
    "b": Motor(2, "sts3215", MotorNormMode.RANGE_0_100),
    "c": Motor(3, "sts3215", MotorNormMode.DEGREES),
}
RANGE = {name: MotorCalibration(motor.id, 0, 0, 1000, 3000) for name, motor in MOTORS.items()}


def reach(bus: Any, goals: dict[str, float]) -> dict[str, float]:
    """Send goals and return where the motors are once they stand there, or after a while."""
    bus.sync_write("Goal_Position", goals)
    end = time.monotonic() + 20.0
    while time.monotonic() < end:
        there: dict[str, float] = bus.sync_read("Present_Position", num_retry=5)
        if all(abs(there[name] - goal) < 3.0 for name, goal in goals.items()):
            break
    return there


def ranges(bus: Any) -> tuple[dict[str, int], dict[str, int]]:
    """Record the ranges while the motors move, until somebody presses enter."""
    bus.sync_write("Goal_Position", dict.fromkeys(MOTORS, 1500), normalize=False)
    reader, writer = os.pipe()
    sys.stdin = os.fdopen(reader)
    threading.Timer(3.0, os.write, (writer, b"\n")).start()
    mins, maxes = bus.record_ranges_of_motion(display_values=False)
    return mins, maxes


def main(path: str) -> None:
    said: dict[str, Any] = {"scan": FeetechMotorsBus.scan_port(path)}
    bus = FeetechMotorsBus(path, MOTORS)
    bus.connect()
    said["models"] = [bus.ping(name, num_retry=5) for name in MOTORS]
    said["everybody"] = bus.broadcast_ping(num_retry=5)
    bus.disable_torque(num_retry=5)
    bus.configure_motors()
    said["delay"] = [bus.read("Return_Delay_Time", name, num_retry=5) for name in MOTORS]
    said["offsets"] = bus.set_half_turn_homings()
    said["middle"] = bus.sync_read("Present_Position", normalize=False, num_retry=5)
    bus.write_calibration(RANGE)
    said["calibrated"] = bus.is_calibrated
    bus.write("P_Coefficient", "a", 16, num_retry=5)
    said["gain"] = bus.read("P_Coefficient", "a", num_retry=5)
    bus.enable_torque(num_retry=5)
    said["reached"] = reach(bus, {"a": -50.0, "b": 75.0, "c": 20.0})
    said["ranges"] = ranges(bus)
    with bus.torque_disabled():
        said["limp"] = bus.sync_read("Torque_Enable", num_retry=5)
    said["held"] = bus.sync_read("Torque_Enable", num_retry=5)
    bus.disconnect()
    other = FeetechMotorsBus(path, {"d": Motor(9, "sts3215", MotorNormMode.DEGREES)})
    other.connect(handshake=False)
    other.setup_motor("d", initial_baudrate=1_000_000, initial_id=3)
    said["renamed"] = other.ping("d", num_retry=5)
    other.disconnect()
    print(json.dumps(said))


if __name__ == "__main__":
    main(sys.argv[1])
