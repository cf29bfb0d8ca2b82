from collections.abc import Callable

import numpy as np
import pytest

from tests.hal.servo_state import MODEL, MOUNTS
from windup.hal.guard.levels import HealthKind, HealthLevels
from windup.hal.guard.persistence import SIGNS, Persistence
from windup.hal.joints import Array

N = 20
LEVELS = HealthLevels.of([MOUNTS[0]] * N, 12.0)
DT = 0.08
WARNING, STOP = 0, 1
LOW, EMPTY = 10.5, 9.0
assert MODEL.limits is not None and EMPTY < MODEL.limits.low < LOW


def first(supply: Callable[[float, int], float], level: int = STOP) -> float | None:
    """Return when a supply (volts at a time for a joint) counts, of servos read in turn."""
    persistence = Persistence(LEVELS)
    volts, read = np.full(N, 12.0), np.zeros(N)
    for tick in range(round(12.0 / DT)):
        now, joint = tick * DT, tick % N
        volts[joint], read[joint] = supply(now, joint), now
        due = persistence.due(values_of(volts), now, now - read)
        if due is not None and due[level].any():
            return now
    return None


def values_of(volts: Array) -> Array:
    values = np.full((len(HealthKind), N), np.nan)
    values[HealthKind.SUPPLY_LOW] = SIGNS[HealthKind.SUPPLY_LOW] * volts
    return values


def test_an_empty_battery_is_seen_within_six_tenths_of_a_second() -> None:
    stopped = first(lambda time, joint: EMPTY if time > 3.0 else 12.0)
    assert stopped == pytest.approx(3.6, abs=2 * DT)


def test_a_dip_whose_readings_grow_old_stops_nobody() -> None:
    assert first(lambda time, joint: EMPTY if 3.0 < time < 3.25 else 12.0) is None


@pytest.mark.parametrize("period", [0.4, 0.43, 0.5])
def test_a_supply_that_sags_with_every_step_stops_nobody(period: float) -> None:
    assert first(lambda time, joint: EMPTY if time % period < 0.5 * period else 11.0) is None


def test_one_joint_that_always_reads_low_is_only_warned_of() -> None:
    def bad_connector(time: float, joint: int) -> float:
        return EMPTY if joint == 3 else 12.0

    assert first(bad_connector) is None
    warned = first(bad_connector, WARNING)
    assert warned is not None and 5.0 < warned < 7.0


def test_a_supply_at_its_level_is_not_below_it() -> None:
    assert first(lambda time, joint: float(LEVELS.warn[HealthKind.SUPPLY_LOW, 0]), WARNING) is None


def test_supply_that_is_only_low_is_no_stop() -> None:
    assert first(lambda time, joint: LOW) is None


def test_an_old_reading_is_not_a_second_one() -> None:
    persistence, hot = Persistence(LEVELS), np.full((len(HealthKind), N), np.nan)
    hot[HealthKind.TEMPERATURE] = 90.0
    for now in np.arange(0.0, 3.0, DT):
        due = persistence.due(hot, now, np.full(N, now))  # read at 0 s, and never again
        assert due is not None and not due.any()
