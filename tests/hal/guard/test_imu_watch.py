from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.hal.imu_samples import DT, GRAVITY, found, noisy, seen, still, tipping, upright
from windup.hal.guard.imu_watch import ImuWatch
from windup.hal.observation import Observation


def test_an_imu_that_rests_is_well() -> None:
    watch = ImuWatch()
    assert found(watch, still(5.0)) is None
    assert watch.warnings == []


def test_a_silent_imu_is_said_after_a_quarter_of_a_second() -> None:
    watch = ImuWatch()
    silence = [seen(k * DT, age=k * DT) for k in range(200)]
    first = found(watch, silence)
    assert first is not None
    time, finding = first
    assert time == pytest.approx(0.25, abs=2 * DT) and finding.stop
    assert str(finding).endswith("(stop at 0.25 s)") and "the IMU is silent" in str(finding)


def test_an_imu_that_never_said_anything_is_silent_too() -> None:
    dumb = [replace(seen(k * DT), imu=None) for k in range(200)]
    first = found(ImuWatch(), dumb)
    assert first is not None and first[0] == pytest.approx(0.25, abs=2 * DT)


def test_an_imu_that_repeats_itself_while_joints_move_is_frozen() -> None:
    frozen = [seen(k * DT, joint=0.2 * k * DT) for k in range(200)]
    first = found(ImuWatch(), frozen)
    assert first is not None
    assert first[0] == pytest.approx(0.5, abs=2 * DT)
    assert str(first[1]) == "the IMU is repeating one sample for 0.5 s (stop at 0.5 s)"


def test_an_imu_that_repeats_itself_while_nothing_moves_is_only_warned_of() -> None:
    watch = ImuWatch()
    first = found(watch, [seen(k * DT) for k in range(300)])
    assert first is not None
    assert first[0] == pytest.approx(1.0, abs=2 * DT) and not first[1].stop


def test_one_new_sample_in_half_a_second_is_enough() -> None:
    sometimes = [seen(k * DT, felt=(0, 0, GRAVITY + k // 50), joint=k * DT) for k in range(300)]
    assert found(ImuWatch(), sometimes) is None


@pytest.mark.parametrize("place", ["rate", "felt"])
def test_what_is_not_a_number_is_said_at_once(place: str) -> None:
    bad = (np.nan, 0.0, GRAVITY)
    first = found(ImuWatch(), [*still(1.0), seen(1.0, **{place: bad})])  # type: ignore[arg-type]
    assert first is not None and first[0] == 1.0
    assert str(first[1]) == "a reading of the IMU is not a number"


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("speed", [1.2, 3.0, 10.0])
def test_a_gyroscope_that_jumps_is_found_within_an_eighth_of_a_second(
    axis: int, speed: float
) -> None:
    watch = ImuWatch()
    rate = speed * np.eye(3)[axis]
    first = found(watch, [*still(1.0), *still(1.0, 1.0, rate)])
    assert first is not None and first[0] == pytest.approx(1.1, abs=3 * DT)
    assert "without an acceleration" in str(first[1])


def test_a_jump_is_doubted_from_its_first_sample_and_forgotten_when_it_was_one() -> None:
    watch = ImuWatch()
    assert found(watch, still(1.0)) is None
    watch.update(seen(1.0, (3.0, 0.0, 0.0)))
    assert watch.gyro.doubted
    assert found(watch, still(1.0, 1.0 + DT)) is None
    assert not watch.gyro.doubted and watch.warnings == []


def test_a_gyroscope_that_drifts_away_is_found_by_gravity() -> None:
    drift = [seen(k * DT, (0.0, 1.5 * k * DT, 0.0), upright(k)) for k in range(300)]
    first = found(ImuWatch(), drift)
    assert first is not None and first[0] < 1.2
    assert "that accelerometer or joints contradict" in str(first[1])


@pytest.mark.parametrize("height", [0.05, 0.15, 0.25, 0.3, 0.4])
def test_a_fall_is_no_spin_wherever_the_imu_sits(height: float) -> None:
    watch = ImuWatch()
    assert found(watch, [*still(1.0), *tipping(2.0, 1.0, height)]) is None
    assert watch.warnings == []


def test_a_body_that_turns_with_gravity_is_well() -> None:
    turning = []
    for k in range(600):  # round and round, slowly enough to feel nothing else
        angle = 1.0 * k * DT
        felt = GRAVITY * np.array([np.sin(angle), 0.0, np.cos(angle)])
        turning.append(seen(k * DT, noisy((0.0, -1.0, 0.0), k), felt))
    assert found(ImuWatch(), turning) is None


@pytest.mark.parametrize(("speed", "wrong"), [(0.0, True), (2.0, False)])
def test_a_turn_about_the_vertical_takes_joints_that_move(speed: float, wrong: bool) -> None:
    turning = [
        seen(k * DT, noisy((0.0, 0.0, min(1.5 * k * DT, 1.5)), k), upright(k), speed=speed)
        for k in range(400)
    ]
    assert (found(ImuWatch(), turning) is not None) == wrong


def test_a_foot_that_slips_turns_the_body_about_the_vertical_unfelt_and_is_no_spin() -> None:
    watch = ImuWatch()
    walking = still(1.0)
    turning = [
        seen(1.0 + k * DT, noisy((0.0, 0.0, 0.9), k), upright(k), speed=2.0) for k in range(60)
    ]
    assert found(watch, [*walking, *turning]) is None


def test_after_a_hole_between_samples_rates_may_be_others() -> None:
    watch = ImuWatch()
    walking = still(1.0)
    turning = [
        seen(1.03 + k * DT, noisy((0.8, 0.0, 0.0), k), upright(k), speed=2.0) for k in range(20)
    ]
    assert found(watch, [*walking, *turning]) is None
    assert not watch.gyro.doubted


def test_a_body_that_walks_may_be_turned_more_suddenly_than_one_that_stands() -> None:
    rates = [1.5 * np.sin(2.0 * np.pi * k / 64) for k in range(257)]
    walking = [seen(k * DT, (rate, 0.0, 0.0), upright(k)) for k, rate in enumerate(rates)]
    later = [len(walking) + k for k in range(20)]
    knocked = [seen(k * DT, noisy((1.2, 0.0, 0.0), k), upright(k)) for k in later]
    spun = [seen(k * DT, noisy((3.0, 0.0, 0.0), k), upright(k)) for k in later]
    assert found(ImuWatch(), [*walking, *knocked]) is None
    first = found(ImuWatch(), [*walking, *spun])
    assert first is not None and first[0] < (later[0] + 16) * DT


def test_a_jump_that_few_samples_show_may_be_one() -> None:
    watch = ImuWatch()
    held_up = [1.0 + k * DT for k in (0, 8, 12, 16)]
    turning = [seen(time, noisy((0.9, 0.0, 0.0), k), upright(k)) for k, time in enumerate(held_up)]
    assert found(watch, [*still(1.0), *turning]) is None
    assert watch.gyro.doubted


def test_a_jump_that_ends_slower_than_it_began_was_one() -> None:
    watch = ImuWatch()
    walking = still(0.5, rate=(0.0, 0.0, 0.6))
    knock = [seen(0.5, (0.9, 0.0, 0.6), upright(0), speed=2.0)]
    after = [seen(0.5 + (k + 1) * DT, (0.0, 0.0, 0.1), upright(k), speed=2.0) for k in range(60)]
    assert found(watch, [*walking, *knock, *after]) is None


def falling(rate: float | None) -> list[Observation]:
    """Return what a body feels that turns faster and faster, its first rate being another one."""
    run = [seen(k * DT, (2.5 + 0.1 * k, 0.0, 0.0), (0.0, 0.1 * k, 4.0)) for k in range(40)]
    if rate is None:
        return run
    return [
        replace(o, imu=replace(o.imu, angular_velocity=np.array([rate, 0.0, 0.01 * k])))
        for k, o in enumerate(run)
        if o.imu is not None
    ]


def test_a_gyroscope_that_stays_at_one_rate_while_the_body_turns_as_fast_is_stuck() -> None:
    first = found(ImuWatch(), falling(3.0))
    assert first is not None and first[0] == pytest.approx(0.1, abs=2 * DT)
    assert (
        str(first[1]) == "the IMU is repeating a rate of 3.0 rad/s about one axis (stop above 0.7)"
    )


def test_a_stuck_axis_is_one_fault_also_between_two_samples() -> None:
    watch = ImuWatch()
    for observation in falling(3.0):
        watch.update(observation)
        watch.update(replace(observation, time=observation.time + 0.5 * DT))
    (warning,) = watch.warnings
    assert warning.count == 1


@pytest.mark.parametrize("rate", [None, 0.0])
def test_rates_that_change_or_are_low_are_not_stuck(rate: float | None) -> None:
    assert found(ImuWatch(), falling(rate)) is None


def test_a_warning_has_its_worst_value_and_how_often_it_began() -> None:
    watch = ImuWatch()
    for begin in (0.0, 2.0, 4.0):
        for k in range(40 + int(begin)):
            watch.update(seen(begin + k * DT, age=k * DT))
        found(watch, still(2.0 - 60 * DT, begin + 60 * DT))
    (warning,) = watch.warnings
    assert warning.record() | {"since": 0.0} == {
        "kind": "imu silent",
        "joints": [],
        "value": pytest.approx(43 * DT),
        "limit": 0.25,
        "count": 3,
        "since": 0.0,
    }


SPELLS = st.lists(
    st.tuples(
        st.sampled_from([0.1, 0.4, 1.2]),
        st.sampled_from([0.0, 0.5, 2.0, np.nan]),
        st.sampled_from([0.0, 0.3]),
        st.booleans(),
    ),
    min_size=1,
    max_size=6,
)


@given(SPELLS, st.integers(0, 1000))
def test_a_verdict_depends_on_nothing_but_the_observations(
    spells: list[tuple[float, float, float, bool]], later: int
) -> None:
    run: list[Observation] = []
    for seconds, rate, age, quiet in spells:
        for k in range(round(seconds / DT)):
            felt = upright(0 if quiet else k)
            run.append(seen(len(run) * DT, (0.0, rate, 0.0), felt, age=age, joint=len(run) * DT))
    shifted = [replace(observation, time=observation.time + later) for observation in run]
    here, there = ImuWatch(), ImuWatch()
    assert [str(here.update(o)) for o in run] == [str(there.update(o)) for o in shifted]
