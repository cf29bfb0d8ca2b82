import numpy as np
import pytest

from windup.hal.geometry.smooth_step import PEAK, smooth_step


def test_it_is_fastest_in_the_middle_and_slow_at_both_ends() -> None:
    s = np.linspace(0.0, 1.0, 1001)
    speed = np.gradient([smooth_step(part) for part in s], s)
    assert speed.max() == pytest.approx(PEAK, abs=1e-4)
    assert speed.argmax() == 500
    assert speed[[0, -1]] == pytest.approx([0.0, 0.0], abs=0.01)
