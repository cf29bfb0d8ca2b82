import pytest
from hypothesis import given
from hypothesis import strategies as st

from windup.sim_twin.wire.servos.profile import RECTANGULAR, STEP, TRAPEZOIDAL, TRIANGULAR, Profile


def test_a_trapezoid_takes_distance_over_top_and_top_over_acceleration() -> None:
    profile = Profile(0.0, 0.0, 10.0, 2.0, 4.0)
    assert profile.kind == TRAPEZOIDAL
    assert profile.duration == pytest.approx(10.0 / 2.0 + 2.0 / 4.0)
    assert profile.state_at(0.5) == pytest.approx((0.5, 2.0))
    assert profile.state_at(2.75) == pytest.approx((5.0, 2.0))
    assert profile.state_at(9.0) == (10.0, 0.0)


def test_short_ways_are_triangles_and_a_missing_limit_a_rectangle_or_a_step() -> None:
    assert Profile(0.0, 0.0, 1.0, 9.0, 4.0).kind == TRIANGULAR
    assert Profile(0.0, 0.0, 1.0, 9.0, 4.0).duration == pytest.approx(1.0)
    assert Profile(0.0, 0.0, -3.0, 2.0, 0.0).kind == RECTANGULAR
    assert Profile(0.0, 0.0, -3.0, 2.0, 0.0).state_at(0.75) == (-1.5, -2.0)
    assert Profile(0.0, 0.0, 1.0, 0.0, 4.0).kind == STEP
    assert Profile(0.0, 0.0, 1.0, 0.0, 4.0).state_at(0.0) == (1.0, 0.0)


def test_a_timed_profile_takes_its_time() -> None:
    assert Profile.timed(0.0, 700.0, 2.0, 0.5).duration == pytest.approx(2.0)
    assert Profile.timed(0.0, 700.0, 2.0, 9.0).duration == pytest.approx(2.0)  # half of it at most


@given(
    st.floats(-50, 50), st.floats(-20, 20), st.floats(-50, 50), st.floats(0.5, 30), st.floats(1, 90)
)
def test_from_any_start_it_is_smooth_within_its_limits_and_ends_at_the_goal(
    start: float, velocity: float, goal: float, top: float, acceleration: float
) -> None:
    profile = Profile(start, velocity, goal, top, acceleration)
    if start == goal:
        return
    dt = profile.duration / 400
    before = profile.state_at(0.0)
    assert before == pytest.approx((start, velocity), abs=1e-6)
    for k in range(1, 400):
        position, speed = profile.state_at(k * dt)
        assert abs(speed) <= max(top, abs(velocity)) + 1e-6
        assert abs(speed - before[1]) <= acceleration * dt + 1e-6
        assert position - before[0] == pytest.approx(
            0.5 * dt * (speed + before[1]), abs=1e-6 + acceleration * dt * dt
        )
        before = (position, speed)
    assert profile.state_at(profile.duration) == pytest.approx((goal, 0.0), abs=1e-6)
    assert before[0] == pytest.approx(goal, abs=1e-6 + (abs(before[1]) + acceleration * dt) * dt)
