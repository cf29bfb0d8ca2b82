"""A script of somebody who has pypot, two MX-28 and an AX-12: ``pypot_client.py PORT``.

Prints what it found as JSON.
"""

import json
import sys
import time
from typing import Any

from pypot.dynamixel.io import DxlIO

MX, AX = (1, 2), 4
EVERYBODY = (*MX, AX)
SETTINGS: dict[str, Any] = {
    "return_delay_time": 0,
    "highest_temperature_limit": 70,
    "voltage_limit": (7.0, 15.0),
    "max_torque": 80.0,
    "moving_speed": 120.0,
    "torque_limit": 60.0,
    "angle_limit": (-100.0, 100.0),
}
"""What is set on the MX-28, and read again."""


def reach(io: Any, goals: dict[int, float]) -> list[float]:
    """Send goals and return where the motors are once they stand there, or after a while."""
    end = time.monotonic() + 20.0
    there: list[float] = []
    while time.monotonic() < end:
        io.set_goal_position(goals)
        there = list(io.get_present_position(tuple(goals)))
        if all(abs(at - goal) < 2.0 for at, goal in zip(there, goals.values(), strict=False)):
            break
    return there


def main(path: str) -> None:
    with DxlIO(path, 1_000_000, timeout=1.0) as io:
        said: dict[str, Any] = {"found": io.scan(range(1, 6)), "models": io.get_model(EVERYBODY)}
        for name, value in SETTINGS.items():
            getattr(io, f"set_{name}")(dict.fromkeys(MX, value))
            said[name] = getattr(io, f"get_{name}")(MX)
        io.switch_led_on(MX)
        said["led"] = io.is_led_on(EVERYBODY)
        io.switch_led_off(MX)
        io.set_pid_gain(dict.fromkeys(MX, (5.0, 2.0, 0.4)))
        said["pid"] = io.get_pid_gain(MX)
        io.set_compliance_slope({AX: (64, 64)})
        said["slope"] = io.get_compliance_slope((AX,))
        io.enable_torque(EVERYBODY)
        said["torque"] = io.is_torque_enabled(EVERYBODY)
        said["reached"] = reach(io, {1: 40.0, 2: -40.0, 4: 30.0})
        said["volts"] = io.get_present_voltage(EVERYBODY)
        said["degrees"] = io.get_present_temperature(EVERYBODY)
        said["loads"] = io.get_present_position_speed_load(EVERYBODY)
        io.disable_torque(EVERYBODY)
        said["limp"] = io.is_torque_enabled(EVERYBODY)
        io.change_id({2: 7})
        said["renamed"] = io.scan((1, 2, 4, 7))
        said["table"] = [dict(table) for table in io.get_control_table((1,))]
    print(json.dumps(said, default=str))


if __name__ == "__main__":
    main(sys.argv[1])
