"""`windup scan`: which servos answer on a port, at which baud rate."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro
from rich.table import Table

from hal.bus import Bus, Found
from hal.errors import HardwareError
from hal.open_port import open_port
from hal.registers import Register
from robots import load_robot
from tools.output import console, write_json


@dataclass(frozen=True, kw_only=True)
class Scan:
    """Look for servos on a port, at every baud rate. Nothing moves."""

    url: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="URL")]
    """The port: /dev/ttyUSB0, usb:SERIAL, socket://HOST:PORT, twin://ROBOT."""
    robot: str | None = None
    """Compare with the servos of this robot."""
    baud: int | None = None
    """Look at this baud rate only."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""

    def run(self) -> int:
        """Scan; returns the exit status."""
        expected = _expected(self.robot)
        port = open_port(self.url)
        try:
            bus = Bus(port)
            found = bus.scan(None if self.baud is None else [self.baud])
            rows = [_describe(bus, servo, expected) for servo in found]
        finally:
            port.close()
        missing = sorted(set(expected) - {servo.id for servo in found})
        self._show(rows, [f"{expected[id]} (id {id})" for id in missing])
        result = {"url": self.url, "servos": rows, "missing_ids": missing}
        write_json(self.json, "scan", result)
        return 3 if missing or not rows else 0

    def _show(self, rows: list[dict[str, Any]], missing: list[str]) -> None:
        if not rows:
            console.print(
                f"nobody answers on {self.url}: is the servo power on, and this the right port?"
            )
            return
        heads = ["id", "model", "firmware", "baud", "V", "degrees C", "error", "joint"]
        table = Table(*heads, box=None)
        for row in rows:
            table.add_row(*(str(row[key]) for key in ROW))
        console.print(table)
        if missing:
            console.print(f"silent: {', '.join(missing)}")


ROW = ("id", "model", "firmware", "baud", "voltage_v", "temperature_c", "error", "joint")


def _expected(robot: str | None) -> dict[int, str]:
    """Return servo id to joint name."""
    if robot is None:
        return {}
    description = load_robot(robot)
    pairs = zip(description.joints.names, description.servos, strict=True)
    return {servo.id: name for name, servo in pairs if servo is not None}


def _describe(bus: Bus, servo: Found, expected: dict[int, str]) -> dict[str, Any]:
    """Return what a servo says of itself."""
    before = bus.port.baud
    bus.port.baud = servo.baud
    try:
        volts = _read(bus, servo.id, bus.family.registers["present_voltage"])
        heat = _read(bus, servo.id, bus.family.registers["present_temperature"])
        error = _read(bus, servo.id, bus.family.registers["hardware_error"])
    finally:
        bus.port.baud = before
    return {
        "id": servo.id,
        "model": servo.model,
        "firmware": servo.firmware,
        "baud": servo.baud,
        "voltage_v": None if volts is None else round(0.1 * volts, 1),
        "temperature_c": heat,
        "error": "" if not error else ", ".join(bus.family.explain(error)),
        "joint": expected.get(servo.id, ""),
    }


def _read(bus: Bus, id: int, register: Register) -> int | None:
    """Return one register, or None where the device has none."""
    try:
        return bus.read(id, register)
    except HardwareError:
        return None
