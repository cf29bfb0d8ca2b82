import numpy as np
import pytest

from windup.control.execution.motion import (
    PEAK,
    Planted,
    Shift,
    Swing,
    cosine_progress,
    shift_time,
)
from windup.control.execution.swing import smooth_progress

HERE, THERE = np.array([0.0, 0.1]), np.array([0.2, 0.0])


def test_a_shift_begins_at_its_start_and_stays_at_its_goal() -> None:
    shift = Shift(HERE, THERE, began=1.0, seconds=0.5, ease=smooth_progress)
    assert shift.at(0.9) == pytest.approx(HERE)
    assert shift.at(1.25) == pytest.approx(0.5 * (HERE + THERE))
    assert shift.at(9.0) == pytest.approx(THERE)
    assert shift.part(9.0) == 1.0


def test_a_curved_shift_bends_toward_its_control_point() -> None:
    via = np.array([0.2, 0.1])
    shift = Shift(HERE, THERE, 0.0, 1.0, smooth_progress, via=via)
    assert shift.at(0.0) == pytest.approx(HERE)
    assert shift.at(1.0) == pytest.approx(THERE)
    assert shift.at(0.5) == pytest.approx(0.25 * HERE + 0.5 * via + 0.25 * THERE)


def test_a_long_shift_takes_the_time_that_its_acceleration_needs() -> None:
    assert shift_time(0.1, least=0.6, pace=np.inf) == 0.6
    seconds = shift_time(0.4, least=0.6, pace=0.4)
    times = np.arange(0.0, seconds, 1e-3)
    way = [0.4 * smooth_progress(time / seconds) for time in times]
    assert np.abs(np.diff(way, 2)).max() / 1e-6 == pytest.approx(0.4, rel=1e-2)
    assert seconds == pytest.approx(np.sqrt(PEAK))


def test_a_swing_rises_comes_down_and_goes_on_down_when_it_is_late() -> None:
    start, target = np.array([0.0, 0.1, 0.01]), np.array([0.3, 0.1])
    swing = Swing(0, 2.0, 0.5, start, target, (3.0, -3.0), 0.06, HERE)
    assert swing.at(2.0)[0] == pytest.approx(start)
    at, yaw = swing.at(2.25)
    assert at == pytest.approx([0.15, 0.1, 0.065])
    assert np.cos(yaw) == pytest.approx(-1.0)  # the short way round
    at, yaw = swing.at(2.5)
    assert at == pytest.approx([0.3, 0.1, 0.0])
    assert np.cos(yaw) == pytest.approx(np.cos(-3.0))
    assert swing.at(2.75)[0][2] == pytest.approx(-0.03)


def test_one_planted_foot_is_replaced_and_the_other_stays() -> None:
    planted = Planted(np.zeros((2, 3)), np.array([3.0, -3.0]))
    assert np.cos(planted.front) == pytest.approx(-1.0)
    moved = planted.step(1, np.array([0.1, 0.2]), 0.5)
    assert moved.places.tolist() == [[0.0, 0.0, 0.0], [0.1, 0.2, 0.0]]
    assert (moved.yaws.tolist(), planted.yaws.tolist()) == ([3.0, 0.5], [3.0, -3.0])


def test_a_cosine_path_is_eased_at_both_ends() -> None:
    assert [cosine_progress(part) for part in (0.0, 0.5, 1.0, 2.0)] == pytest.approx([0, 0.5, 1, 1])
