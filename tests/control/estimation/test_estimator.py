from dataclasses import replace

import numpy as np
import pytest

from tests.control.biped import AIR, BOTH_FEET, DT, GRAVITY, Run, estimator, lean, observed, turned
from windup.hal.errors import StateMissingError
from windup.hal.joints import Array
from windup.hal.observation import ImuState


def test_a_robot_at_rest_stays_where_it_is_with_its_soles_on_the_floor() -> None:
    base = Run(estimator()).hold(2.0)
    assert base.position == pytest.approx([0.0, 0.0, 0.25], abs=1e-9)
    assert base.linear_velocity == pytest.approx(np.zeros(3), abs=1e-9)
    assert base.orientation == pytest.approx([1.0, 0.0, 0.0, 0.0], abs=1e-9)
    assert base.confidence > 0.95


def test_a_tilted_robot_is_seen_tilted_and_its_lowest_corner_touches_the_floor() -> None:
    pitch = 0.1
    ready = np.full(2, -pitch)  # level soles
    base = Run(estimator()).hold(0.1, pitch=pitch, leg=ready)
    assert lean(base) == pytest.approx(pitch, abs=1e-6)
    assert base.position[2] == pytest.approx(0.2 * np.cos(pitch) + 0.05, abs=1e-6)


def test_the_bias_of_a_gyro_at_rest_is_found() -> None:
    wrong = np.array([0.02, -0.03, 0.025])
    run = Run(estimator())
    run.hold(10.0, bias=wrong)
    assert run.estimator.gyro_bias == pytest.approx(wrong, abs=1e-3)
    assert abs(lean(run.bases[-1])) < np.radians(0.2)
    assert run.bases[-1].angular_velocity == pytest.approx(np.zeros(3), abs=1e-3)


def test_the_bias_survives_a_reset() -> None:
    run = Run(estimator())
    run.hold(5.0, bias=np.full(3, 0.02))
    found = run.estimator.gyro_bias.copy()
    run.estimator.reset()
    run.tick(bias=np.full(3, 0.02))
    assert run.estimator.gyro_bias == pytest.approx(found, abs=1e-3)


def test_a_wrong_start_is_corrected_by_gravity() -> None:
    run = Run(estimator())
    run.tick(acceleration=np.array([0.0, 0.0, -GRAVITY]))  # falling: the vertical is not felt
    assert lean(run.bases[0]) == 0.0
    base = run.hold(3.0, pitch=0.05, leg=np.full(2, -0.05))
    assert lean(base) == pytest.approx(0.05, abs=0.005)


def test_accelerations_of_walking_are_not_taken_for_leaning() -> None:
    run = Run(estimator())
    run.hold(1.0)
    for tick in range(1000):
        # The base sways over level soles that stand still; the legs show it.
        phase = 2.0 * np.pi * 2.0 * tick * DT
        swing, swing_rate = 0.1 * np.sin(phase), 0.1 * 4.0 * np.pi * np.cos(phase)
        reach = 0.05
        sway = -reach * 0.1 * (4.0 * np.pi) ** 2 * np.sin(phase)
        run.tick(
            acceleration=np.array([sway, 0.0, 0.0]),
            leg=np.full(2, swing),
            leg_rate=np.full(2, swing_rate),
        )
    leans = np.array([lean(base) for base in run.bases[500:]])
    # A plain accelerometer would say up to 4.6 degrees.
    assert np.degrees(np.abs(leans).max()) < 1.0


def test_velocity_comes_from_the_legs() -> None:
    run = Run(estimator())
    run.hold(0.5)
    # Legs that turn carry their level soles, 0.05 m below the axis, back by that for each rad.
    base = run.hold(0.2, leg_rate=np.full(2, -2.0))
    assert base.linear_velocity[0] == pytest.approx(-0.1, abs=0.03)


@pytest.mark.parametrize("every", [1, 3])
def test_an_imu_slower_than_the_loop_is_held_and_led(every: int) -> None:
    run = Run(estimator())
    run.hold(0.2, contacts=AIR)
    rate, pitch = 0.5, 0.0
    for tick in range(100):
        age = tick % every * DT
        pitch = rate * tick * DT
        base = run.tick(
            pitch=pitch - rate * age, pitch_rate=rate, imu_age=age, contacts=AIR, leg=np.zeros(2)
        )
    # One tick of the turn's beginning is lost to the trapezoid.
    assert lean(base) == pytest.approx(pitch, abs=rate * DT)


def test_an_imu_that_lags_the_joints_is_led_to_their_time() -> None:
    late = 0.012
    run = Run(estimator())
    rate = 0.5
    for tick in range(200):
        sampled = max(tick * DT - late, 0.0)
        turning = rate if tick * DT > late else 0.0
        base = run.tick(pitch=rate * sampled, pitch_rate=turning, imu_age=late, contacts=AIR)
    assert lean(base) == pytest.approx(rate * 199 * DT, abs=rate * DT)


def test_the_delay_of_a_low_pass_filter_is_made_good() -> None:
    lag = 0.004
    run = Run(estimator(lag=lag))
    shown, angle = 0.0, 0.0
    for tick in range(200):
        rate = np.sin(20.0 * tick * DT)
        angle = (1.0 - np.cos(20.0 * tick * DT)) / 20.0
        for part in range(1, 41):  # a filter of first order, in forty parts of a tick
            now = np.sin(20.0 * (tick - 1 + part / 40) * DT) if tick else 0.0
            shown += (now - shown) * (1.0 - np.exp(-DT / 40 / lag))
        base = run.tick(pitch=angle, pitch_rate=shown, contacts=AIR)
        assert lean(base) == pytest.approx(angle, abs=2e-3)
        assert base.angular_velocity[1] == pytest.approx(rate, abs=0.05)


def test_a_joint_that_answers_late_is_carried_on() -> None:
    fresh, late = Run(estimator(switches=False)), Run(estimator(switches=False))
    for tick in range(50):
        leg, rate, age = 0.2 * tick * DT, 0.2, 0.02
        a = fresh.tick(leg=np.full(2, leg), leg_rate=np.full(2, rate))
        b = late.tick(
            leg=np.array([leg, leg - rate * age]),
            leg_rate=np.full(2, rate),
            joint_age=np.array([0.0, age]),
        )
    assert b.position == pytest.approx(a.position, abs=1e-9)


def test_a_foot_that_slips_is_not_believed_at_once() -> None:
    run = Run(estimator())
    run.hold(1.0)
    # Both soles slide forward at 0.2 m/s for 40 ms, the base stays.
    base = run.hold(0.04, leg_rate=np.full(2, -4.0))
    assert np.abs(base.linear_velocity[0]) < 0.1
    base = run.hold(1.0)
    assert np.abs(base.linear_velocity[0]) < 0.01
    assert np.degrees(abs(lean(base))) < 1.0


def test_a_foot_that_rocks_on_its_toe_speaks_for_its_toe() -> None:
    run = Run(estimator())
    run.hold(0.5)
    toes = np.array([6.0, 0.0, 6.0, 0.0])

    def place(angle: float) -> Array:
        """Base of a robot that turns as a whole about its toes, seen from there."""
        c, s = np.cos(angle), np.sin(angle)
        return np.array([-0.07 * c + 0.25 * s, 0.0, 0.07 * s + 0.25 * c])

    pitches = 0.1 * (1.0 - np.cos(10.0 * DT * np.arange(-2, 50)))
    places = np.array([place(pitch) for pitch in pitches])
    velocities = np.gradient(places, DT, axis=0)
    accelerations = np.gradient(velocities, DT, axis=0)
    rates = np.gradient(pitches, DT)
    for tick in range(2, 50):
        base = run.tick(
            pitch=pitches[tick],
            pitch_rate=rates[tick],
            acceleration=accelerations[tick],
            contacts=toes,
        )
        assert base.linear_velocity == pytest.approx(velocities[tick], abs=0.02)
        assert base.position[2] == pytest.approx(places[tick, 2], abs=1e-3)
    assert lean(base) == pytest.approx(pitches[49], abs=5e-3)


def test_the_foot_with_the_load_is_the_one_that_counts() -> None:
    left_only = np.array([6.0, 6.0, 0.0, 0.0])
    run = Run(estimator())
    run.hold(0.5, contacts=left_only)
    base = run.hold(0.2, contacts=left_only, leg_rate=np.array([0.0, 5.0]))
    assert base.linear_velocity == pytest.approx(np.zeros(3), abs=1e-6)


def test_without_a_foot_down_confidence_falls_and_the_robot_with_it() -> None:
    run = Run(estimator())
    run.hold(1.0)
    sure = run.bases[-1].confidence
    falling = np.array([0.0, 0.0, -GRAVITY])
    base = run.hold(0.2, contacts=AIR, acceleration=falling)
    assert base.linear_velocity[2] == pytest.approx(-GRAVITY * 0.2, abs=0.05)
    base = run.hold(0.3, contacts=AIR, acceleration=falling)
    assert base.confidence < 0.35 * sure
    base = run.hold(1.0)
    assert base.confidence > 0.9 * sure


def test_a_stale_imu_lowers_confidence() -> None:
    fresh, stale = Run(estimator()), Run(estimator())
    for run, age in ((fresh, 0.0), (stale, 0.08)):
        run.hold(0.5)
        run.hold(0.3, imu_age=age, contacts=AIR)
    assert stale.bases[-1].confidence < fresh.bases[-1].confidence


def test_a_robot_that_lies_down_does_not_stand_on_its_soles() -> None:
    run = Run(estimator(switches=False))
    base = run.hold(1.0, pitch=1.5)
    assert base.confidence < 0.1
    assert lean(base) == pytest.approx(1.5, abs=0.05)


def test_contacts_that_nobody_measures_are_filled_in() -> None:
    standing = estimator(switches=False).update(observed(0.0, contacts=np.zeros(0)), DT)
    assert standing.contacts.sum() == pytest.approx(1.2 * GRAVITY)
    assert (standing.contacts > 1.0).all()
    lifted = estimator(switches=False).update(
        observed(0.0, contacts=np.zeros(0), leg=np.array([0.0, 0.2])), DT
    )
    assert (lifted.contacts > 1.0).tolist() == [False, False, True, False]


def test_contacts_that_are_measured_are_kept() -> None:
    seen = observed(0.0, contacts=BOTH_FEET)
    assert estimator().update(seen, DT).contacts is seen.contacts


def test_time_that_goes_back_is_a_new_beginning() -> None:
    run = Run(estimator())
    run.hold(1.0, leg_rate=np.full(2, -1.0))
    assert abs(run.bases[-1].position[0]) > 0.01
    run.time = 0.0
    assert run.tick().position[:2] == pytest.approx([0.0, 0.0])


def test_the_same_instant_twice_changes_nothing() -> None:
    run = Run(estimator())
    run.hold(0.2, leg_rate=np.full(2, -1.0))
    seen = observed(run.time, leg_rate=np.full(2, -1.0))
    first = run.estimator.update(seen, DT).base
    second = run.estimator.update(seen, DT).base
    assert first is not None and second is not None
    assert second.position == pytest.approx(first.position, abs=1e-5)
    assert second.orientation == pytest.approx(first.orientation, abs=1e-4)


def test_the_imu_s_own_orientation_is_used_only_when_asked_for() -> None:
    told = turned(0.05)
    leans = {}
    for fused in (False, True):
        estimate = estimator(fused=fused)
        for tick in range(1000):
            seen = observed(tick * DT)
            assert seen.imu is not None
            imu = replace(seen.imu, orientation=told)
            base = estimate.update(replace(seen, imu=imu), DT).base
        assert base is not None
        leans[fused] = lean(base)
    assert leans[False] == pytest.approx(0.0, abs=1e-6)
    assert leans[True] > 0.005


def test_a_robot_without_an_imu_is_told_so() -> None:
    seen = replace(observed(0.0), imu=None)
    with pytest.raises(StateMissingError, match="cannot be estimated without an IMU"):
        estimator().update(seen, DT)


def test_the_imu_may_sit_anywhere() -> None:
    # A base that pitches about its own origin, in the air; an IMU 0.1 m above it is flung about.
    above = np.array([0.0, 0.0, 0.1])
    estimate = estimator()
    estimate._imu = above
    rate = 1.0
    for tick in range(50):
        seen = observed(tick * DT, pitch=rate * tick * DT, pitch_rate=rate, contacts=AIR)
        assert seen.imu is not None
        inward = np.array([0.0, 0.0, -(rate**2) * 0.1])
        imu = ImuState(None, seen.imu.angular_velocity, seen.imu.acceleration + inward, 0.0)
        base = estimate.update(replace(seen, imu=imu), DT).base
    assert base is not None
    # The IMU was taken to be at rest at first: that is wrong by rate x 0.1 m, and nothing else.
    assert base.linear_velocity[0] == pytest.approx(-0.1, abs=0.01)
