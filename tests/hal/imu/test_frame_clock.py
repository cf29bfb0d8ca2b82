"""Dating frames that come at an even rate."""

import pytest

from windup.hal.imu.frame_clock import LATEST, FrameClock

PERIOD = 0.01


def looks(clock: FrameClock, came: list[float], every: float) -> list[float]:
    """Return how wrong the dates are of frames that `came`, for a host that looks now and then."""
    return [
        clock.timestamp(number % 256, -(-time // every) * every) - time
        for number, time in enumerate(came)
    ]


def test_after_a_few_looks_the_time_that_a_frame_has_lain_is_known() -> None:
    # A look every 8 ms finds a frame up to 8 ms old; one in four comes just before a look.
    errors = looks(FrameClock(PERIOD), [0.0019 + PERIOD * n for n in range(600)], 0.008)
    assert max(errors[:4]) > 4e-3
    assert all(-1e-9 < error < 5e-4 for error in errors[4:])


@pytest.mark.parametrize("real", [PERIOD * 0.9999, PERIOD * 1.0003])
def test_a_senders_clock_may_be_a_little_wrong(real: float) -> None:
    errors = looks(FrameClock(PERIOD), [0.0019 + real * n for n in range(2000)], 0.0079)
    assert all(-1e-9 < error < 1e-3 for error in errors[50:])


def test_a_sender_that_has_paused_is_dated_anew() -> None:
    clock = FrameClock(PERIOD)
    clock.timestamp(0, 1.0)
    assert clock.timestamp(1, 1.01 + 2.0 * LATEST) == 1.01 + 2.0 * LATEST


def test_lost_frames_are_counted_by_their_numbers() -> None:
    clock = FrameClock(PERIOD)
    clock.timestamp(254, 1.0)
    assert clock.timestamp(3, 1.057) == pytest.approx(1.05, abs=1e-4)
