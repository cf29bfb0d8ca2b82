"""`windup health`: diagnoses a robot from its telemetry, without affecting the run."""

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Group
from rich.live import Live
from rich.table import Table
from rich.text import Text

from windup.hal.errors import TelemetryError, UsageError
from windup.hal.telemetry.reader import TelemetryReader
from windup.hal.telemetry.runtime_folder import ring_path
from windup.robots import RobotDescription, load_robot
from windup.tools.bringup.diagnosis import Diagnosis, Limits
from windup.tools.options.faults import with_faults
from windup.tools.terminal.command import Command
from windup.tools.terminal.output import console, write_json

INTERVAL = 0.5
"""Time between two updates of `--watch`, s."""


@dataclass(frozen=True, kw_only=True)
class Health(Command):
    """Diagnose a robot from the telemetry of its present run, or of its last."""

    robot: Annotated[str, tyro.conf.Positional]
    """Name of a robot, or path of its folder."""
    port: str | None = None
    """Port on which it runs; its twin otherwise."""
    faults: str = ""
    """Faults of the run, as given to the command that runs it."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""
    once: bool = False
    """Diagnose once and exit, which is the default."""
    watch: bool = False
    """Update twice a second until Ctrl-C."""

    def check(self) -> None:
        """Check the options; see `Command.check`."""
        super().check()
        if self.once and self.watch:
            raise UsageError("--once and --watch: give one of them")

    def run(self) -> int:
        """Diagnose; return the exit status: 0 healthy, 1 not healthy, 2 no telemetry."""
        robot = load_robot(self.robot)
        diagnosis = self._diagnose(robot)
        if self.watch:
            diagnosis = self._watch(robot, diagnosis)
        else:
            console.print(format_health(diagnosis))
        write_json(self.json, "health", diagnosis.result())
        return 0 if diagnosis.healthy else 1

    def _diagnose(self, robot: RobotDescription) -> Diagnosis:
        """Return the present health; the ring is opened anew because each run has its own.

        Raises:
            TelemetryError: There is no telemetry.
        """
        try:
            with TelemetryReader(
                ring_path(robot.name, with_faults(self.port, self.faults))
            ) as reader:
                return Diagnosis.of(reader, Limits.of(robot), time.time())
        except TelemetryError as error:
            where = f" --port '{self.port}'" if self.port else " --realtime"
            where += f" --faults '{self.faults}'" if self.faults else ""
            raise TelemetryError(
                f"{error}; start a run with `windup walk {self.robot}{where}`"
            ) from None

    def _watch(self, robot: RobotDescription, diagnosis: Diagnosis) -> Diagnosis:
        try:
            with Live(format_health(diagnosis), console=console, auto_refresh=False) as live:
                while True:
                    time.sleep(INTERVAL)
                    diagnosis = self._diagnose(robot)
                    live.update(format_health(diagnosis), refresh=True)
        except KeyboardInterrupt:
            return diagnosis


def format_health(diagnosis: Diagnosis) -> Group:
    """Return the health as text: the state, a table of the joints, and the problems."""
    result = diagnosis.result()
    rate = "" if result["rate_hz"] is None else f"{result['rate_hz']:.1f} Hz of "
    why = "" if result["reason"] is None else f" ({result['reason']})"
    lines = [
        f"{result['robot']}: {result['state']}{why}, {result['robot_state']} in the last tick, "
        f"{result['silence_s']:.1f} s ago",
        f"{rate}{result['rate_nominal_hz']:g} Hz, {result['missed']} of {result['ticks']} ticks "
        f"missed, tick {result['tick_ms']['p50']:.2f} ms, p99 {result['tick_ms']['p99']:.2f} ms",
        _counts("bus errors", result["bus_errors"]),
        _counts("clamps", result["clamps"]),
        _counts("driver clamps", result["driver_clamps"]),
    ]
    end = [Text(str(problem), style="red") for problem in diagnosis.problems]
    healthy = [Text("healthy", style="green")]
    return Group(*map(Text, filter(None, lines)), _table(result["joints"]), *(end or healthy))


def _counts(title: str, counts: dict[str, int]) -> str:
    found = ", ".join(f"{name} {count}" for name, count in counts.items() if count)
    return f"{title}: {found}" if found else ""


def _table(joints: list[dict[str, float]]) -> Table:
    table = Table("joint", box=None, padding=(0, 2, 0, 0))
    for title in ("deg C", "V", "age ms", "clamped"):
        table.add_column(title, justify="right")
    for row in joints:
        table.add_row(
            str(row["name"]),
            f"{row['temperature_c']:.0f}",
            f"{row['voltage_v']:.1f}",
            f"{1e3 * row['age_max_s']:.0f}",
            f"{row['clamped_share']:.0%}",
        )
    return table
