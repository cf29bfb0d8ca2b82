"""Diagnoses a run: compares its telemetry with limits, and advises on every problem.

Supply, temperature, load, stall and IMU are checked by the same watches as during the run.
"""

import os
from dataclasses import dataclass, field, fields
from shlex import quote
from typing import Any

import numpy as np

from windup.hal.errors import TelemetryError
from windup.hal.guard import HealthKind, HealthLevels
from windup.hal.guard.finding import FINDING_TEXTS, format_names
from windup.hal.joints import Joints
from windup.hal.telemetry.header import Header, bits_of
from windup.hal.telemetry.reader import TelemetryReader, Ticks
from windup.robots import RobotDescription
from windup.tools.bringup.replay import findings
from windup.tools.terminal.slowness import PLANS, TICKS, Slowness

COUNTERS = ("missed", "plans", "late_plans")
STANDSTILL = 1.0
"""Time without a tick after which a loop that has not ended counts as standing still, s."""


@dataclass(frozen=True)
class Limits:
    """Limits of a healthy run.

    Attributes:
        joints: The robot's joints.
        health: Warning and stop levels of the joints.
        age: Age of a joint's or the IMU's state, s; at twice that the guard stops the robot.
        missed: Share of the ticks that are late.
        late_plans: Share of the plans that are late.
        errors: Number of bus errors of one kind per tick.
        clamped: Share of the ticks in which one joint is clamped.
    """

    joints: Joints
    health: HealthLevels
    age: float = 0.125
    missed: float = TICKS
    late_plans: float = PLANS
    errors: float = 0.01
    clamped: float = 0.1

    @classmethod
    def of(cls, robot: RobotDescription) -> "Limits":
        """Return the limits of a robot."""
        return cls(robot.joints, robot.health)

    def record(self) -> dict[str, Any]:
        """Return the limits as plain data; levels are by kind and joint."""
        plain = {item.name: getattr(self, item.name) for item in fields(self)[2:]}
        levels = {
            FINDING_TEXTS[kind].name: {
                "warn": self.health.warn[kind],
                "stop": self.health.stop[kind],
            }
            for kind in HealthKind
        }
        return plain | {"levels": levels}


@dataclass(frozen=True)
class HealthProblem:
    """One problem of a run, with the part concerned and the remedy."""

    subject: str
    problem: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.subject}: {self.problem}; {self.remedy}"

    def record(self) -> dict[str, str]:
        """Return the problem as plain data."""
        return {"who": self.subject, "what": self.problem, "do": self.remedy}


@dataclass
class Diagnosis:
    """The health of a run, over as much of it as the telemetry ring holds.

    Attributes:
        header: Header of its telemetry.
        ticks: (m,) the ticks, at least one.
        ended: Reason why the run ended, or None.
        limits: Limits of a healthy run.
        now: Present time, s since 1970.
        problems: What is not healthy.
    """

    header: Header
    ticks: Ticks
    ended: str | None
    limits: Limits
    now: float
    problems: list[HealthProblem] = field(default_factory=list, init=False)

    @classmethod
    def of(cls, reader: TelemetryReader, limits: Limits, now: float) -> "Diagnosis":
        """Return the health of the last run in a ring.

        Raises:
            TelemetryError: No tick has been written yet.
        """
        ticks = _last_run(reader.since())
        if not len(ticks):
            raise TelemetryError(f"{reader.path}: no tick has been written yet")
        return cls(reader.header, ticks, reader.ended, limits, now)

    def __post_init__(self) -> None:
        self.newest = self.ticks[-1]
        limits = self.limits
        self.silence = max(self.now - float(self.newest["wall"]), 0.0)
        self._judge_loop()
        self._judge_bus()
        self.findings = list(findings(self.header, self.ticks, limits.joints, limits.health))
        self._judge_joints()

    @property
    def healthy(self) -> bool:
        """True when there are no problems."""
        return not self.problems

    @property
    def state(self) -> str:
        """State of the run: "running", "ended", "standing still" or "dead"."""
        if self.ended is not None:
            return "ended"
        if not _alive(self.header.pid):
            return "dead"
        return "running" if self.silence < STANDSTILL else "standing still"

    @property
    def robot_state(self) -> str:
        """State of the robot in the newest tick, such as "walking"."""
        return self.header.states[int(self.newest["state"])]

    @property
    def rate(self) -> float | None:
        """Ticks per second of the backend's time over the ring, Hz; None if unknown."""
        seconds = float(self.newest["time"] - self.ticks[0]["time"])
        return (len(self.ticks) - 1) / seconds if seconds > 0.0 else None

    @property
    def slowness(self) -> Slowness:
        """Late ticks and plans over the ring."""
        missed, plans, late = (int(self.growth(name)) for name in COUNTERS)
        return Slowness(
            self.header.rate_hz,
            ticks=len(self.ticks),
            missed=missed,
            plans=plans,
            late=late,
        )

    @property
    def missed(self) -> float:
        """Share of the ticks that were late."""
        return self.slowness.missed_share

    def growth(self, name: str) -> Any:
        """Return the growth of a counter over the ring."""
        return self.newest[name].astype(np.int64) - self.ticks[0][name].astype(np.int64)

    def bus_errors(self) -> dict[str, int]:
        """Return the number of bus errors by kind, over the ring."""
        return {k: int(n) for k, n in zip(self.header.errors, self.growth("errors"), strict=True)}

    def clamps(self) -> dict[str, int]:
        """Return the number of commands changed by each clamp, over the ring."""
        return {k: int(n) for k, n in zip(self.header.clamps, self.growth("clamps"), strict=True)}

    def driver_clamps(self) -> dict[str, int]:
        """Return the number of commands changed by each clamp of the driver, over the ring."""
        counts = self.growth("driver_clamps")
        return {k: int(n) for k, n in zip(self.header.driver_clamps, counts, strict=True)}

    def joints(self) -> list[dict[str, Any]]:
        """Return one row per joint: present values, largest age and share of clamped ticks."""
        ages, clamped = self.ticks["age"].max(axis=0), self.growth("clamped") / len(self.ticks)
        columns = zip(
            self.header.joints,
            ages,
            clamped,
            self.newest["temperature"],
            self.newest["voltage"],
            self.newest["alert"],
            strict=True,
        )
        return [
            {
                "name": name,
                "age_max_s": float(age),
                "clamped_share": float(share),
                "temperature_c": float(temperature),
                "voltage_v": float(voltage),
                "alerts": bits_of(alert, self.header.alerts),
            }
            for name, age, share, temperature, voltage, alert in columns
        ]

    def result(self) -> dict[str, Any]:
        """Return the whole diagnosis as plain data."""
        tick = np.percentile(self.ticks["tick_time"], [50, 99]) * 1e3
        late = np.percentile(self.ticks["lateness"], [50, 99]) * 1e3
        return {
            "robot": self.header.robot,
            "port": self.header.port,
            "healthy": self.healthy,
            "state": self.state,
            "robot_state": self.robot_state,
            "reason": self.ended,
            "silence_s": self.silence,
            "rate_hz": self.rate,
            "rate_nominal_hz": self.header.rate_hz,
            "ticks": int(self.newest["tick"]),
            "missed": int(self.newest["missed"]),
            "missed_share": self.missed,
            "tick_ms": {"p50": float(tick[0]), "p99": float(tick[1])},
            "lateness_ms": {"p50": float(late[0]), "p99": float(late[1])},
            "imu_age_s": float(self.newest["imu_age"]),
            "bus_errors": self.bus_errors(),
            "clamps": {name: count for name, count in self.clamps().items() if count},
            "driver_clamps": {name: n for name, n in self.driver_clamps().items() if n},
            "joints": self.joints(),
            "warnings": [finding.record() for finding in self.findings] + self.slowness.records(),
            "limits": self.limits.record(),
            "complaints": [problem.record() for problem in self.problems],
        }

    def _judge_loop(self) -> None:
        if self.state == "dead":
            what = f"process {self.header.pid} died during its run"
            self._add_problem("loop", what, "torque may be on: switch it off with `windup stop`")
        elif self.state == "standing still":
            what = f"no tick for {self.silence:.1f} s"
            self._add_problem("loop", what, f"is process {self.header.pid} stopped or swapped out?")
        if slow := self.slowness:
            self._add_problem("loop", slow.description, slow.remedy)
        age = float(self.ticks["imu_age"].max())
        if age > self.limits.age:
            what = f"silent for {age:.2f} s (limit {self.limits.age:g} s)"
            self._add_problem("imu", what, "check its cable")

    def _judge_bus(self) -> None:
        port = self.header.port or "URL"
        for kind, count in self.bus_errors().items():
            if count > self.limits.errors * len(self.ticks):
                what = f"{kind!r} {count} times in {len(self.ticks)} ticks"
                self._add_problem(
                    "bus", what, f"check cables and power, then `windup scan {quote(port)}`"
                )

    def _judge_joints(self) -> None:
        limits = self.limits
        for row in self.joints():
            name = row["name"]
            if row["alerts"]:
                what = f"its servo reports: {', '.join(row['alerts'])}"
                self._add_problem(name, what, "remove the cause before it shuts down")
            if row["age_max_s"] > limits.age:
                what = f"silent for {row['age_max_s']:.2f} s (limit {limits.age:g} s)"
                self._add_problem(name, what, "check its cable and power")
            if row["clamped_share"] > limits.clamped:
                what = f"clamped in {row['clamped_share']:.0%} of the ticks"
                self._add_problem(
                    name, what, "command smaller values, or widen its limits in robot.toml"
                )

        for finding in self.findings:
            who = format_names(finding.joints) or finding.text.subject
            self._add_problem(who, finding.description, finding.text.remedy)

    def _add_problem(self, subject: str, problem: str, remedy: str) -> None:
        self.problems.append(HealthProblem(subject, problem, remedy))


def _last_run(ticks: Ticks) -> Ticks:
    """Return the ticks of the last run in the ring."""
    return ticks[ticks["run"] == ticks["run"][-1]] if len(ticks) else ticks


def _alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
