"""A script of somebody who has LeRobot and two SCS0009, which know no sync read: ``PORT``.

Makes every call of the bus class that is meant for them and prints what it found as JSON.
"""

import json
import sys
from collections.abc import Callable
from typing import Any

from lerobot.motors import Motor, MotorCalibration, MotorNormMode
from lerobot.motors.feetech import FeetechMotorsBus

from tests.sim_twin.wire.clients.lerobot_client import be_patient, until
from tests.sim_twin.wire.clients.record import calls, recorded

MODEL, PROTOCOL = "scs0009", 1
MOTORS = {
    "a": Motor(1, MODEL, MotorNormMode.DEGREES),
    "b": Motor(2, MODEL, MotorNormMode.RANGE_M100_100),
}


def refused(call: Callable[[], Any]) -> str:
    """Return the name of what LeRobot raises."""
    try:
        call()
    except Exception as error:
        return type(error).__name__
    return ""


def main(path: str) -> None:
    be_patient()
    kind, asked = recorded(FeetechMotorsBus)
    kind.available_baudrates = [1_000_000]
    bus = kind(path, MOTORS, protocol_version=PROTOCOL)
    bus.connect()
    said: dict[str, Any] = {"pings": [bus.ping(name) for name in MOTORS]}
    said["baud"] = bus.get_baudrate()
    said["refused"] = [
        refused(lambda: bus.sync_read("Present_Position")),
        refused(bus.broadcast_ping),
        refused(lambda: bus.scan_port(path, protocol_version=PROTOCOL)),
        refused(bus.set_half_turn_homings),
        refused(bus.record_ranges_of_motion),
    ]
    bus.disable_torque()
    bus.configure_motors()
    bus.write_calibration({name: MotorCalibration(0, 0, 0, 200, 800) for name in MOTORS})
    said["calibrated"] = bus.is_calibrated
    said["limits"] = [(one.range_min, one.range_max) for one in bus.read_calibration().values()]
    bus.enable_torque()
    goals = {"a": 20.0, "b": -50.0}
    bus.sync_write("Goal_Position", goals)
    said["reached"] = until(
        lambda: [bus.read("Present_Position", name) for name in MOTORS],
        lambda at: all(abs(a - b) < 2.0 for a, b in zip(at, goals.values(), strict=True)),
    )
    with bus.torque_disabled("a"):
        said["limp"] = [bus.read("Torque_Enable", name) for name in MOTORS]
    said["held"] = [bus.read("Torque_Enable", name) for name in MOTORS]
    bus.disconnect()
    new = kind(path, {"d": Motor(9, MODEL, MotorNormMode.DEGREES)}, protocol_version=PROTOCOL)
    new.setup_motor("d", initial_baudrate=1_000_000)  # it takes the first that it finds
    said["renamed"] = new.ping("d")
    new.disconnect()
    said["uncalled"] = sorted(calls(FeetechMotorsBus) - asked)
    print(json.dumps(said))


if __name__ == "__main__":
    main(*sys.argv[1:])
