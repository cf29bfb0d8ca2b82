"""`windup scan`: lists the servos that answer on a port, with their baud rates."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro
from rich.progress import BarColumn, Progress, TextColumn

from windup.hal.errors import UsageError
from windup.hal.families import families
from windup.hal.port.open_port import open_port
from windup.hal.ranges import Range
from windup.robots import load_robot
from windup.sim_twin.wire import parse_address
from windup.sim_twin.wire.world.address import SCHEME
from windup.tools.bringup.scan_text import narrow_lines, problems_found, table
from windup.tools.bringup.survey import Survey, scan_targets
from windup.tools.options.faults import with_faults
from windup.tools.terminal.command import Command
from windup.tools.terminal.output import console, write_json


@dataclass(frozen=True, kw_only=True)
class Scan(Command):
    """Look for servos on a port, at every baud rate. Nothing moves."""

    url: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="URL")]
    """The port: /dev/ttyUSB0, usb:SERIAL, socket://HOST:PORT, twin://ROBOT."""
    robot: str | None = None
    """Robot whose servos are expected there."""
    faults: str = ""
    """Faults of a twin:// port: drop:0.01,unplug:at=5:seconds=1,...; an unknown kind lists all
    kinds."""
    baud: Annotated[int, Range(1, 10_000_000, "baud")] | None = None
    """Scan at this baud rate only."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""

    def check(self) -> None:
        """Check the options; see `Command.check`."""
        super().check()
        if self._url.startswith(f"{SCHEME}://"):
            parse_address(self._url)
        known = sorted({baud for family in families() for baud in family.bauds})
        if self.baud is not None and self.baud not in known:
            raise UsageError(f"--baud {self.baud}: give one of {', '.join(map(str, known))}")

    @property
    def _url(self) -> str:
        return with_faults(self.url, self.faults) or self.url

    def run(self) -> int:
        """Scan; return the exit status: 3 if no servo answers or one is missing or wrong."""
        expected = _expected(self.robot)
        port = open_port(self._url)
        survey = Survey(port, expected)
        try:
            with _progress() as progress:
                bar = progress.add_task("", total=len(list(scan_targets(port, self.baud))))
                survey.update(
                    self.baud, lambda what: progress.update(bar, advance=1, description=what)
                )
        finally:
            port.close()
        there = {row["id"] for row in (*survey.servos, *survey.protocol_1)}
        missing = sorted(set(expected) - there)
        self._show(survey, [f"{expected[id]} (id {id})" for id in missing])
        invalid = [{"id": one.id, "baud": baud, "bytes": one.data.hex()}
                   for baud, _, one in survey.invalid]  # fmt: skip
        result = {"url": self.url, "servos": survey.servos, "missing_ids": missing}
        old = {"protocol_1": survey.protocol_1}
        more = {
            "unknown": survey.unknown,
            "doubled_ids": survey.duplicate_ids,
            "not_understood": invalid,
        }
        write_json(self.json, "scan", result | old | more)
        wrong = missing or survey.duplicate_ids or survey.protocol_1
        return 3 if wrong or not survey.servos else 0

    def _show(self, survey: Survey, missing: list[str]) -> None:
        rows, width = survey.servos, console.width
        if rows:
            for line in narrow_lines(rows, width):
                console.print(line, markup=False)
            console.print(table(rows, width))
        for line in problems_found(survey, self.url, missing):
            console.print(line, markup=False)


def _progress() -> Progress:
    """Return a progress bar that fits a narrow terminal."""
    return Progress(
        BarColumn(bar_width=10),
        TextColumn("{task.description}", markup=False),
        console=console,
        transient=True,
        disable=not console.is_terminal,
    )


def _expected(robot: str | None) -> dict[int, str]:
    """Return the joint names by servo id."""
    if robot is None:
        return {}
    description = load_robot(robot)
    pairs = zip(description.joints.names, description.servos, strict=True)
    return {servo.id: name for name, servo in pairs if servo is not None}
