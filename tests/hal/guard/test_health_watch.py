from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.hal.servo_state import DT, STALL, goal, seen, stop_of, stretch, watch
from windup.hal.command import JointCommand
from windup.hal.guard.watch import PERIOD
from windup.hal.observation import Observation


@pytest.mark.parametrize(
    ("knee", "after", "says"),
    [
        ({"temperature": 73.0}, 1.0, "knee is at 73 degrees C (stop at 72): let it cool"),
        (
            {"voltage": 9.7},
            0.5,
            "hip, knee and ankle are on 9.7 V (stop below 10.0): charge the battery",
        ),
        (
            {"voltage": 16.4},
            0.5,
            "hip, knee and ankle are on 16.4 V (stop above 16.0): switch the power off",
        ),
    ],
)
def test_a_value_that_stays_beyond_its_stop_level_stops_the_robot(
    knee: dict[str, float], after: float, says: str
) -> None:
    stopped = stop_of(watch(), stretch(6.0, **knee))
    assert stopped is not None
    assert stopped[0] == pytest.approx(after, abs=PERIOD + DT)
    assert stopped[1].startswith(says)


def test_the_message_ends_with_what_shows_more() -> None:
    stopped = stop_of(watch("; look with `windup health op3`"), stretch(2.0, temperature=75.0))
    assert stopped is not None and stopped[1].endswith("helps; look with `windup health op3`")


@pytest.mark.parametrize("knee", [{"voltage": 8.0}, {"temperature": 250.0}])
def test_one_bad_sample_is_neither_a_stop_nor_a_warning(knee: dict[str, float]) -> None:
    judge = watch()
    once = [*stretch(1.0), *stretch(0.1, begin=1.0, **knee), *stretch(2.0, begin=1.1)]
    assert stop_of(judge, once) is None
    assert judge.warnings == []


@pytest.mark.parametrize("name", ["voltage", "temperature", "torque"])
def test_what_a_joint_does_not_measure_is_neither_well_nor_unwell(name: str) -> None:
    judge = watch()
    assert stop_of(judge, stretch(3.0, **{name: np.nan})) is None
    assert judge.warnings == []


def test_a_mean_load_stops_the_robot_and_a_peak_does_not() -> None:
    stopped = stop_of(watch(), stretch(3.0, torque=-0.9 * STALL))
    assert stopped is not None
    assert stopped[0] == pytest.approx(-np.log(1.0 - 0.75 / 0.9), abs=0.15)
    assert stopped[1].startswith("knee is at 75 % of stall torque for a second (stop at 75 %)")
    peaks = [o for k in range(10) for o in (*stretch(0.2, 0.5 * k, torque=STALL),
                                            *stretch(0.3, 0.5 * k + 0.2))]  # fmt: skip
    assert stop_of(watch(), peaks) is None


def test_a_blocked_joint_stops_the_robot() -> None:
    blocked = stretch(2.0, torque=0.7 * STALL)
    stopped = stop_of(watch(), blocked, goal(knee=0.3))
    assert stopped is not None
    assert stopped[0] == pytest.approx(0.8, abs=0.1)
    assert "knee is blocked at full torque for 0.8 s (stop at 0.8 s)" in stopped[1]


def test_a_servo_that_measures_no_torque_is_blocked_by_what_its_goal_asks() -> None:
    stopped = stop_of(watch(), stretch(2.0, torque=np.nan), goal(knee=0.3))
    assert stopped is not None and "blocked" in stopped[1]


@pytest.mark.parametrize(
    ("knee", "command"),
    [
        ({"torque": 0.7 * STALL, "velocity": 0.5}, goal(0.3)),  # it moves
        ({"torque": 0.7 * STALL}, goal(0.1)),  # it is nearly there
        ({"torque": 0.1 * STALL}, goal(0.3)),  # it pushes at nothing
        ({"torque": 0.7 * STALL}, None),  # nobody drives it
    ],
)
def test_a_joint_that_moves_or_has_no_need_to_is_not_blocked(
    knee: dict[str, float], command: JointCommand | None
) -> None:
    assert stop_of(watch(), stretch(1.0, **knee), command) is None


def test_forty_warnings_of_one_cause_are_one() -> None:
    judge = watch()
    for k in range(4):
        spell = [*stretch(1.2, 3.0 * k, temperature=66.0 + k), *stretch(1.8, 3.0 * k + 1.2)]
        assert stop_of(judge, spell) is None
    (warning,) = judge.warnings
    assert str(warning) == "knee was at 69 degrees C (warning at 65)"
    record = warning.record()
    assert record.pop("since") == pytest.approx(1.0, abs=PERIOD + DT)
    assert record == {
        "kind": "temperature",
        "joints": ["knee"],
        "value": 69.0,
        "limit": 65.0,
        "count": 4,
    }


def test_a_supply_that_all_share_is_one_warning() -> None:
    judge = watch()
    for observation in stretch(1.0):
        observation.joints.voltage[:] = [10.6, 10.5, 10.7]
        assert judge.update(observation) is None
    (warning,) = judge.warnings
    assert str(warning) == "hip, knee and ankle were on 10.5 V (warning below 10.8)"
    assert warning.count == 3


def test_a_clock_that_begins_again_begins_the_watch_again() -> None:
    judge = watch()
    assert stop_of(judge, stretch(0.4, begin=5.0, voltage=9.0)) is None
    assert stop_of(judge, stretch(0.4, begin=0.0, voltage=9.0)) is None


def test_a_look_after_a_long_while_counts_for_a_tick() -> None:
    judge = watch()
    assert judge.update(seen(0.0)) is None
    assert judge.update(seen(60.0, torque=STALL), goal(0.3)) is None
    assert judge.warnings == []


values = st.fixed_dictionaries(
    {
        "voltage": st.sampled_from([12.0, 10.5, 9.0, 17.0, np.nan]),
        "temperature": st.sampled_from([30.0, 66.0, 80.0, np.nan]),
        "torque": st.sampled_from([0.0, 0.7 * STALL, -STALL, np.nan]),
        "velocity": st.sampled_from([0.0, 1.0]),
    }
)


def verdicts(run: list[Observation]) -> list[str]:
    judge = watch()
    found = [str(judge.update(observation, goal(0.3))) for observation in run]
    records = [warning.record() for warning in judge.warnings]
    return [*found, *(str(record | {"since": record["since"] - run[0].time}) for record in records)]


@given(
    st.lists(st.tuples(st.sampled_from([0.05, 0.3, 0.7, 1.5]), values), min_size=1, max_size=6),
    st.integers(0, 1000),
)
def test_a_verdict_depends_on_nothing_but_the_observations(
    spells: list[tuple[float, dict[str, float]]], later: int
) -> None:
    run: list[Observation] = []
    for seconds, knee in spells:
        run += stretch(seconds, len(run) * DT, **knee)
    shifted = [replace(observation, time=observation.time + later) for observation in run]
    assert verdicts(run) == verdicts(shifted)
