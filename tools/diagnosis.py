"""Is a robot well? Its telemetry held against limits, and what to do about each complaint."""

import os
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from hal.errors import TelemetryError
from hal.telemetry import TelemetryReader, Ticks
from hal.telemetry_layout import Header
from robots import RobotDescription

STANDSTILL = 1.0
"""Silence after which a loop that has not ended counts as standing still, s."""


@dataclass(frozen=True)
class Limits:
    """What is still healthy.

    Attributes:
        age: Age of a joint's or the IMU's state, s; at twice that the guard stops the robot.
        missed: Share of ticks that came too late.
        errors: Bus errors of one kind for each tick.
        clamped: Share of the ticks in which one joint is clamped.
        temperature: degrees C; Dynamixel X servos switch off at 70 to 80.
        low: Supply, V.
        high: Supply, V.
    """

    low: float
    high: float
    age: float = 0.125
    missed: float = 0.01
    errors: float = 0.01
    clamped: float = 0.1
    temperature: float = 65.0

    @classmethod
    def of(cls, robot: RobotDescription) -> "Limits":
        """Return the limits of a robot: 10 % under its supply, 25 % over it."""
        return cls(low=0.9 * robot.drive.supply, high=1.25 * robot.drive.supply)


@dataclass(frozen=True)
class Complaint:
    """Who is unwell, what is wrong, and what to do."""

    who: str
    what: str
    do: str

    def __str__(self) -> str:
        return f"{self.who}: {self.what}; {self.do}"


@dataclass
class Diagnosis:
    """The health of a run, over as much of it as the ring holds.

    Attributes:
        header: What its telemetry says of itself.
        ticks: (m,) the ticks, one at least.
        ended: Why the run ended, or None.
        limits: What is healthy.
        now: s since 1970.
        complaints: What is not.
    """

    header: Header
    ticks: Ticks
    ended: str | None
    limits: Limits
    now: float
    complaints: list[Complaint] = field(default_factory=list, init=False)

    @classmethod
    def of(cls, reader: TelemetryReader, limits: Limits, now: float) -> "Diagnosis":
        """Return the health of the last run in a ring.

        Raises:
            TelemetryError: No tick has been written yet.
        """
        ticks = _last_run(reader.since())
        if not len(ticks):
            raise TelemetryError(f"{reader.path}: no tick was written yet")
        return cls(reader.header, ticks, reader.ended, limits, now)

    def __post_init__(self) -> None:
        self.newest = self.ticks[-1]
        self.silence = max(self.now - float(self.newest["wall"]), 0.0)
        self._judge_loop()
        self._judge_bus()
        self._judge_joints()

    @property
    def healthy(self) -> bool:
        """True when there is nothing to complain of."""
        return not self.complaints

    @property
    def state(self) -> str:
        """Running, ended, standing still or dead."""
        if self.ended is not None:
            return "ended"
        if not _alive(self.header.pid):
            return "dead"
        return "running" if self.silence < STANDSTILL else "standing still"

    @property
    def rate(self) -> float | None:
        """Ticks a second of the backend's time, over the ring."""
        seconds = float(self.newest["time"] - self.ticks[0]["time"])
        return (len(self.ticks) - 1) / seconds if seconds > 0.0 else None

    @property
    def missed(self) -> float:
        """Share of the ticks that came too late."""
        missed = self.change("missed")
        return float(missed / (len(self.ticks) + missed))

    def change(self, name: str) -> Any:
        """Return by how much a counter has grown over the ring."""
        return self.newest[name] - self.ticks[0][name]

    def bus_errors(self) -> dict[str, int]:
        """Return kind to count, over the ring."""
        return {k: int(n) for k, n in zip(self.header.errors, self.change("errors"), strict=True)}

    def clamps(self) -> dict[str, int]:
        """Return name of the clamp to commands changed, over the ring."""
        return {k: int(n) for k, n in zip(self.header.clamps, self.change("clamps"), strict=True)}

    def joints(self) -> list[dict[str, Any]]:
        """Return one row a joint: present values, largest age and share of clamped ticks."""
        ages, clamped = self.ticks["age"].max(axis=0), self.change("clamped") / len(self.ticks)
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
                "alerts": self._alerts(alert),
            }
            for name, age, share, temperature, voltage, alert in columns
        ]

    def result(self) -> dict[str, Any]:
        """Return everything, for programs."""
        tick = np.percentile(self.ticks["tick_time"], [50, 99]) * 1e3
        return {
            "robot": self.header.robot,
            "port": self.header.port,
            "healthy": self.healthy,
            "state": self.state,
            "reason": self.ended,
            "silence_s": self.silence,
            "rate_hz": self.rate,
            "rate_nominal_hz": self.header.rate_hz,
            "ticks": int(self.newest["tick"]),
            "missed": int(self.newest["missed"]),
            "missed_share": self.missed,
            "tick_ms": {"p50": float(tick[0]), "p99": float(tick[1])},
            "imu_age_s": float(self.newest["imu_age"]),
            "bus_errors": self.bus_errors(),
            "clamps": {name: count for name, count in self.clamps().items() if count},
            "joints": self.joints(),
            "limits": asdict(self.limits),
            "complaints": [asdict(complaint) for complaint in self.complaints],
        }

    def _judge_loop(self) -> None:
        if self.state == "dead":
            what = f"process {self.header.pid} died without ending its run"
            self._complain("loop", what, "look at its output; servos without a watchdog may hold")
        elif self.state == "standing still":
            what = f"no tick for {self.silence:.1f} s"
            self._complain("loop", what, f"is process {self.header.pid} stopped or swapped out?")
        if self.missed > self.limits.missed:
            what = f"{self.missed:.1%} of the ticks came too late (limit {self.limits.missed:.0%})"
            self._complain("loop", what, "stop what else is running, or lower --rate")
        age = float(self.ticks["imu_age"].max())
        if age > self.limits.age:
            what = f"silent for {age:.2f} s (limit {self.limits.age:g} s)"
            self._complain("imu", what, "check its cable")

    def _judge_bus(self) -> None:
        port = self.header.port or "URL"
        for kind, count in self.bus_errors().items():
            if count > self.limits.errors * len(self.ticks):
                what = f"{kind!r} {count} times in {len(self.ticks)} ticks"
                self._complain("bus", what, f"check cables and power, then `windup scan {port}`")

    def _judge_joints(self) -> None:
        limits = self.limits
        for row in self.joints():
            name, volts = row["name"], row["voltage_v"]
            if row["alerts"]:
                what = f"its servo signals: {', '.join(row['alerts'])}"
                self._complain(name, what, "remove the cause before it shuts down")
            if row["age_max_s"] > limits.age:
                what = f"silent for {row['age_max_s']:.2f} s (limit {limits.age:g} s)"
                self._complain(name, what, "check its cable and power")
            if row["temperature_c"] > limits.temperature:
                what = f"{row['temperature_c']:.0f} degrees C (limit {limits.temperature:.0f})"
                self._complain(name, what, "stop and let it cool; a pose with less load helps")
            if volts < limits.low:
                what = f"{volts:.1f} V (limit {limits.low:.1f} V)"
                self._complain(name, what, "charge the battery, or check its connector")
            if volts > limits.high:
                what = f"{volts:.1f} V (limit {limits.high:.1f} V)"
                self._complain(name, what, "switch the power off: it is the wrong supply")
            if row["clamped_share"] > limits.clamped:
                what = f"clamped in {row['clamped_share']:.0%} of the ticks"
                self._complain(name, what, "ask for less, or widen its limits in robot.toml")

    def _complain(self, who: str, what: str, do: str) -> None:
        self.complaints.append(Complaint(who, what, do))

    def _alerts(self, bits: float) -> list[str]:
        return [kind for bit, kind in enumerate(self.header.alerts) if int(bits) >> bit & 1]


def _last_run(ticks: Ticks) -> Ticks:
    """Return the ticks of the last run in the ring."""
    again = np.flatnonzero(np.diff(ticks["tick"]) <= 0)
    return ticks[int(again[-1]) + 1 :] if len(again) else ticks


def _alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
