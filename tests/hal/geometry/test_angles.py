from math import pi

import numpy as np
import pytest

from windup.hal.geometry.angles import wrapped


def test_angles_end_up_between_minus_pi_and_pi() -> None:
    angles = np.linspace(-7.0 * pi, 7.0 * pi, 100)
    found = wrapped(angles)
    assert (found >= -pi).all() and (found < pi).all()
    np.testing.assert_allclose(np.exp(1j * found), np.exp(1j * angles), atol=1e-12)
    assert wrapped(1.5 * pi) == pytest.approx(-0.5 * pi)
