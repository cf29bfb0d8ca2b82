"""Rates and rotation from an IMU without a gyroscope."""

import numpy as np
import pytest

from windup.control.estimation.fused_attitude import FusedAttitude
from windup.hal.joints import Array
from windup.hal.observation import ImuState


def spun(angle: float) -> Array:
    return np.array([np.cos(angle / 2), 0.0, np.sin(angle / 2), 0.0])


def sample(angle: float) -> ImuState:
    return ImuState(spun(angle), np.zeros(3), np.zeros(3), 0.0)


def test_a_rate_that_grows_evenly_is_known_at_any_time_between_samples() -> None:
    grown, late = 8.0, 0.0066
    subject = FusedAttitude()
    turned = 0.0
    for tick in range(40):
        now = 0.008 * tick
        sampled = 0.01 * np.floor(max(now - late, 0.0) / 0.01)
        motion = subject.follow(sample(0.5 * grown * sampled**2), sampled, now)
        turned += motion.turn[1]
        if tick > 6:
            assert motion.rate[1] == pytest.approx(grown * now, rel=1e-6)
            assert turned == pytest.approx(0.5 * grown * now**2, rel=1e-6)


def test_samples_lost_leave_no_error_behind() -> None:
    subject = FusedAttitude()
    turned = sum(
        subject.follow(sample(0.2 * at), at, at).turn[1] for at in (0.0, 0.01, 0.02, 0.5, 0.51)
    )
    assert turned == pytest.approx(0.2 * 0.51)


def test_one_sample_seen_twice_is_carried_on() -> None:
    subject = FusedAttitude()
    for at in (0.0, 0.01, 0.02):
        subject.follow(sample(at), at, at)
    motion = subject.follow(sample(0.02), 0.02, 0.028)
    assert motion.turn[1] == pytest.approx(0.008)
    assert motion.rate[1] == pytest.approx(1.0)
