"""A script of somebody who has pypot, two MX-28, an MX-106 and an AX-12: ``PORT``.

Makes every call of its bus class and prints what it found as JSON.
"""

import json
import sys
import time
from collections.abc import Callable
from functools import partial
from typing import Any

from pypot.dynamixel.error import BaseErrorHandler
from pypot.dynamixel.io import DxlIO

from tests.sim_twin.wire.clients.record import calls, recorded

MX, STRONG, AX = (1, 2), (3,), (4,)
EVERYBODY = (*MX, *STRONG, *AX)
PATIENCE = 4.0  # s, for a busy machine
OVERHEATING = ("Overheating Error",)
SETTINGS: dict[str, tuple[tuple[int, ...], Any]] = {
    "return_delay_time": (EVERYBODY, 20),
    "highest_temperature_limit": (EVERYBODY, 65.0),
    "voltage_limit": (EVERYBODY, (7.0, 14.0)),
    "max_torque": (EVERYBODY, 80.0),
    "torque_limit": (EVERYBODY, 70.0),
    "alarm_LED": (EVERYBODY, OVERHEATING),
    "alarm_shutdown": (EVERYBODY, OVERHEATING),
    "status_return_level": (EVERYBODY, "read"),
    "moving_speed": (EVERYBODY, 180.0),
    "angle_limit": (EVERYBODY, (-100.0, 100.0)),
    "pid_gain": ((*MX, *STRONG), (5.0, 2.0, 0.4)),
    "drive_mode": (STRONG, ("reverse", "master")),
    "goal_acceleration": (STRONG, 858.3),
    "compliance_margin": (AX, (2, 3)),
    "compliance_slope": (AX, (64, 16)),
    "punch": (AX, 40),
}
"""What is set, in which servos, and read again."""


class Handler(BaseErrorHandler):  # type: ignore[misc]  # pypot has no types
    """Notes the alarm of a supply out of its limits."""

    heard = 0

    def handle_input_voltage_error(self, _: Any) -> None:
        Handler.heard += 1


def until(ask: Callable[[], Any], good: Callable[[Any], bool] = bool) -> Any:
    """Ask until the answer is good, or a busy machine has had its time."""
    end = time.monotonic() + 30.0
    while not good(answer := ask()) and time.monotonic() < end:
        pass
    return answer


def changed(write: Callable[[], Any], read: Callable[[], Any]) -> Any:
    """Write until every servo has another value than before, and return the values.

    pypot flushes its output before each packet. On a pseudo-terminal the kernel throws away what
    the other side has not read by then (`tty_buffer_flush`); adapters of usb-serial do not.
    """
    before = read()

    def written() -> Any:
        write()
        return read()

    return until(written, lambda now: all(a != b for a, b in zip(before, now, strict=True)))


def reach(io: Any, goals: dict[int, float]) -> list[float]:
    """Send goals and return where the motors stand once they are there."""

    def at() -> list[float]:
        io.set_goal_position(goals)
        return list(io.get_present_position(tuple(goals)))

    def there(at: list[float]) -> bool:
        return all(abs(a - b) < 2.0 for a, b in zip(at, goals.values(), strict=True))

    return list(until(at, there))


def look(io: Any) -> dict[str, Any]:
    """Find the servos, set what can be set, and read it again."""
    said: dict[str, Any] = {"found": io.scan(EVERYBODY), "models": io.get_model(EVERYBODY)}
    said["used"] = io.get_used_ports() == [io.port]
    said["firmware"] = io.get_firmware(EVERYBODY)
    said["settings"] = {}
    for name, (ids, value) in SETTINGS.items():
        write, read = getattr(io, f"set_{name}"), getattr(io, f"get_{name}")
        said["settings"][name] = changed(
            partial(write, dict.fromkeys(ids, value)), partial(read, ids)
        )
    lit = changed(lambda: io.switch_led_on(MX), lambda: io.is_led_on(MX))
    said["led"] = [lit, changed(lambda: io.switch_led_off(MX), lambda: io.is_led_on(MX))]
    said["tables"] = [dict(table) for table in io.get_control_table(EVERYBODY)]
    said["volts"] = io.get_present_voltage(EVERYBODY)
    said["warmth"] = io.get_present_temperature(EVERYBODY)
    said["current"] = io.get_present_current(STRONG)
    return said


def move(io: Any) -> dict[str, Any]:
    """Switch the torque and go to goals."""
    torque = partial(io.is_torque_enabled, EVERYBODY)
    said: dict[str, Any] = {"torque": changed(lambda: io.enable_torque(EVERYBODY), torque)}
    goals = {1: 40.0, 2: -40.0, 3: 10.0, 4: 30.0}
    said["moving"] = until(lambda: io.set_goal_position(goals) or any(io.is_moving(EVERYBODY)))
    said["reached"], said["goals"] = reach(io, goals), io.get_goal_position(EVERYBODY)
    three = dict.fromkeys(EVERYBODY, (0.0, 90.0, 60.0))
    said["three"] = changed(
        lambda: io.set_goal_position_speed_load(three),
        lambda: io.get_goal_position_speed_load(EVERYBODY),
    )
    said["again"] = reach(io, dict.fromkeys(EVERYBODY, 0.0))
    said["present"] = io.get_present_position_speed_load(EVERYBODY)
    return {**said, **turn(io), "limp": changed(lambda: io.disable_torque(EVERYBODY), torque)}


def turn(io: Any) -> dict[str, Any]:
    """Let an MX and an AX turn as wheels."""
    limits = {id: partial(io.get_angle_limit, (id,), convert=False) for id in (1, 4)}
    changed(lambda: io.set_wheel_mode((1,)), limits[1])
    changed(lambda: io.set_control_mode({4: "wheel"}), limits[4])
    said: dict[str, Any] = {"wheels": io.get_control_mode(EVERYBODY)}
    speeds = {1: -100.0, 4: 200.0}
    said["turning"] = until(
        lambda: io.set_moving_speed(speeds) or io.get_present_speed((1, 4)),
        lambda speed: speed[0] < -80.0 and speed[1] > 20.0,
    )
    said["loads"] = io.get_present_load((1, 4))
    for id, limit in limits.items():
        changed(partial(io.set_joint_mode, (id,)), limit)
    said["joints"] = [limit() for limit in limits.values()]
    return said


def rename(io: Any) -> dict[str, Any]:
    """Silence a servo, change id and baud rate, and go back to the factory's."""
    levels = partial(io.get_status_return_level, EVERYBODY)
    changed(lambda: io.set_status_return_level(dict.fromkeys(EVERYBODY, "always")), levels)
    io.timeout = 0.1
    mute = partial(io.get_status_return_level, (2,))
    said: dict[str, Any] = {"mute": changed(lambda: io.set_status_return_level({2: "never"}), mute)}
    changed(lambda: io.set_status_return_level({2: "always"}), mute)
    until(lambda: io.change_id({2: 7}) or io.ping(7))
    said["absent"] = io.ping(2)
    until(lambda: io.change_baudrate({7: 500_000}) or not io.ping(7))
    io.baudrate = 500_000
    said["renamed"] = until(lambda: io.ping(7))
    io.baudrate = 1_000_000
    io.factory_reset()  # takes the first that answers
    io.baudrate = 57_600
    said["factory"] = until(lambda: io.ping(1))
    said["delay"] = io.get_return_delay_time((1,))
    return said


def main(path: str) -> None:
    bus, asked = recorded(DxlIO)
    with bus(path, 1_000_000, PATIENCE) as io:
        said = {**look(io), **move(io)}
        io.close()
        said["closed"] = io.closed
        io.open(path, 1_000_000, PATIENCE)
        io.flush()
        said["modes"] = io.get_control_mode(EVERYBODY)
        high = {3: (13.0, 14.0)}
        changed(lambda: io.set_voltage_limit(high), lambda: io.get_voltage_limit((3,)))
        said.update(rename(io))
    with bus(path, 1_000_000, PATIENCE, error_handler_cls=Handler) as io:
        until(lambda: io.get_present_voltage((3,)) and Handler.heard)
    said["alarms"], said["uncalled"] = Handler.heard, sorted(calls(DxlIO) - asked)
    print(json.dumps(said))


if __name__ == "__main__":
    main(sys.argv[1])
