import numpy as np
import pytest

from windup.control.execution.swing import bezier, gaussian_progress, lift, swing_foot

START, END = np.array([0.0, 0.05, 0.0]), np.array([0.1, 0.07, 0.0])
GRID = np.linspace(0.0, 1.0, 201)


def test_progress_begins_and_ends_and_never_turns_back() -> None:
    way = np.array([gaussian_progress(s) for s in GRID])
    assert way[0] == pytest.approx(0.0)
    assert way[-1] == pytest.approx(1.0)
    assert np.all(np.diff(way) > 0.0)


def test_the_speed_is_a_gaussian_of_the_papers_width() -> None:
    speed = np.gradient([gaussian_progress(s) for s in GRID], GRID)
    ratio = speed[1:-1] / speed[100]
    assert ratio == pytest.approx(np.exp(-((GRID[1:-1] - 0.5) ** 2) / (2 * 0.08)), rel=0.01)


def test_the_foot_leaves_the_ground_and_comes_back_to_it() -> None:
    way = np.array([swing_foot(START, END, s, 0.03) for s in GRID])
    assert way[0] == pytest.approx(START)
    assert way[-1] == pytest.approx(END)
    assert way[:, 2].max() == pytest.approx(0.03)
    assert way[1:-1, 2].min() > 0.0


def test_an_early_lift_peaks_before_the_middle() -> None:
    assert np.argmax([lift(s, 0.03, early=1.0) for s in GRID]) < 80
    assert np.argmax([lift(s, 0.03) for s in GRID]) == 100


def test_the_centre_of_mass_goes_by_the_foot_that_stays() -> None:
    pivot = np.array([0.0, -0.05, 0.0])
    way = np.array([bezier(START, pivot, END, s) for s in GRID])
    assert way[0] == pytest.approx(START)
    assert way[-1] == pytest.approx(END)
    assert way[:, 1].min() < 0.02
