"""The cost of a gait: a weighted sum of terms, each about 1 for a gait that is poor in it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from windup.hal.errors import UnknownNameError, UsageError
from windup.hal.ranges import Range, read_number

WEIGHT = Range(0.0, 1e6)
Row = dict[str, Any]
CROSSED = 20.0  # interpenetration of the feet for a cost of 1, mm
AIR = 0.2  # share of the flight time for a cost of 0


def _speed(row: Row, aim: float) -> float:
    if row["speed_m_s"] is None:
        return 1.0
    return abs(row["speed_m_s"] - aim) / max(abs(aim), 0.1)


def _effort(row: Row, _: float) -> float:
    cost = row["cost_of_transport"]
    return 10.0 if cost is None else float(np.log1p(cost))


def _drift(row: Row, _: float) -> float:
    way = max(abs(row["distance_m"]), 0.1)
    return abs(row["heading_deg"]) / 90.0 + min(abs(row["lateral_m"]) / way, 2.0)


def _flight(row: Row, _: float) -> float:
    return max(1.0 - row["flights"] / max(row["steps"] - 1, 1), 0.0)


def _air(row: Row, _: float) -> float:
    share = row["flight_time_s"] / max(row["sim_time_s"], 1e-9)
    return max(1.0 - share / AIR, 0.0)


def _cross(row: Row, _: float) -> float:
    clear = row["foot_clearance_mm"]
    return 0.0 if clear is None else max(-clear / CROSSED, 0.0)


def _skip(row: Row, _: float) -> float:
    return 1.0 - float(row["skips"])


TERMS: dict[str, Callable[[Row, float], float]] = {
    "falls": lambda row, _: 1.0 - row["steps"] / row["steps_requested"],  # share not walked
    "speed": _speed,  # error of the speed, as a share of --aim
    "effort": _effort,  # log (1 + cost of transport): work / (weight x distance)
    "shake": lambda row, _: row["shake_rad_s"],  # rms of the base's angular velocity, rad/s
    "drift": _drift,  # 1 for a heading of 90 degrees, or for as far sideways as forward
    "cross": _cross,  # interpenetration of the feet
    "flight": _flight,  # share of the steps without a flight phase
    "skip": _skip,  # share of the touchdowns that do not skip: left, left, right, right
    "air": _air,  # lack of flight time, compared with a fifth of the time
}
USUAL = {"falls": 10.0, "speed": 1.0, "effort": 1.0, "shake": 0.2, "drift": 0.2}


@dataclass(frozen=True)
class Objective:
    """A weighted sum of terms.

    Attributes:
        weights: Weight of each term.
        aim: Desired walking speed, m/s.
    """

    weights: dict[str, float]
    aim: float | None = None

    def cost(self, rows: list[Row]) -> float:
        """Return the mean cost of several runs; lower is better."""
        return float(np.mean([self._of(row) for row in rows]))

    def terms(self, rows: list[Row]) -> dict[str, float]:
        """Return the mean of each term, unweighted."""
        return {
            name: float(np.mean([TERMS[name](row, self.aim or 0.0) for row in rows]))
            for name in self.weights
        }

    def _of(self, row: Row) -> float:
        aim = self.aim or 0.0
        return sum(weight * TERMS[name](row, aim) for name, weight in self.weights.items())


def objective(given: tuple[str, ...], aim: float | None) -> Objective:
    """Return the objective given as "TERM" or "TERM=WEIGHT", by default the usual one.

    Raises:
        UnknownNameError: There is no such term.
        UsageError: A weight is not a number of 0 or more, or the term `speed` has no aim.
    """
    weights = {}
    for text in given:
        name, equals, value = text.partition("=")
        if name not in TERMS:
            raise UnknownNameError("--objective", name, TERMS)
        weights[name] = USUAL.get(name, 1.0)
        if equals:
            weights[name] = read_number(f"--objective {text}", value, WEIGHT)
    if not weights:
        weights = {name: w for name, w in USUAL.items() if name != "speed" or aim is not None}
    if "speed" in weights and aim is None:
        raise UsageError("--objective speed: say which with --aim, m/s")
    return Objective(weights, aim)
