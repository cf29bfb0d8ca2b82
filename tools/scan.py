"""`windup scan`: which servos answer on a port, at which baud rate."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro
from rich.table import Table

from hal.bus import Bus, Found
from hal.errors import HardwareError, UsageError
from hal.families import DYNAMIXEL_X, FAMILIES
from hal.open_port import open_port
from hal.ranges import Range
from robots import load_robot
from sim_twin.wire import parse_address
from sim_twin.wire.address import SCHEME
from tools.command import Command
from tools.faults import with_faults
from tools.output import console, write_json


@dataclass(frozen=True, kw_only=True)
class Scan(Command):
    """Look for servos on a port, at every baud rate. Nothing moves."""

    url: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="URL")]
    """The port: /dev/ttyUSB0, usb:SERIAL, socket://HOST:PORT, twin://ROBOT."""
    robot: str | None = None
    """Compare with the servos of this robot."""
    faults: str = ""
    """What goes wrong on a twin:// port: drop:0.01,unplug:at=5:seconds=1,...; a wrong word gets the
    list."""
    baud: Annotated[int, Range(1, 10_000_000, "baud")] | None = None
    """Look at this baud rate only."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        if self._url.startswith(f"{SCHEME}://"):
            parse_address(self._url)
        known = sorted({baud for family in FAMILIES for baud in family.bauds})
        if self.baud is not None and self.baud not in known:
            raise UsageError(f"--baud {self.baud}: give one of {', '.join(map(str, known))}")

    @property
    def _url(self) -> str:
        return with_faults(self.url, self.faults) or self.url

    def run(self) -> int:
        """Scan; returns the exit status."""
        expected = _expected(self.robot)
        port = open_port(self._url)
        try:
            rows = [row for family in FAMILIES for row in self._family(Bus(port, family), expected)]
        finally:
            port.close()
        missing = sorted(set(expected) - {row["id"] for row in rows})
        self._show(rows, [f"{expected[id]} (id {id})" for id in missing])
        result = {"url": self.url, "servos": rows, "missing_ids": missing}
        write_json(self.json, "scan", result)
        return 3 if missing or not rows else 0

    def _family(self, bus: Bus, expected: dict[int, str]) -> list[dict[str, Any]]:
        """Return the servos of one family; other families that answer are left to their own."""
        bauds = bus.family.bauds if self.baud is None else [self.baud]
        found = bus.scan([baud for baud in bauds if baud in bus.family.bauds])
        # Protocol 1 is spoken by three families: a model number says whose it is.
        mine = [servo for servo in found if servo.model_number in bus.family.numbers]
        if bus.family is DYNAMIXEL_X:
            mine = found
        return [_describe(bus, servo, expected) for servo in mine]

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
        volts = _read(bus, servo.id, "present_voltage")
        heat = _read(bus, servo.id, "present_temperature")
        error = _read(bus, servo.id, "hardware_error")
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


def _read(bus: Bus, id: int, name: str) -> int | None:
    """Return one register, or None where the device has none."""
    register = bus.family.registers.get(name)
    try:
        return None if register is None else bus.read(id, register)
    except HardwareError:
        return None
