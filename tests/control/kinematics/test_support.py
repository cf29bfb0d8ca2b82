import numpy as np
import pytest

from windup.control.kinematics.support import SupportRegion

SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])


@pytest.mark.parametrize(
    ("point", "margin"), [((0.5, 0.5), 0.5), ((0.9, 0.5), 0.1), ((1.2, 0.5), -0.2), ((1.0, 0.2), 0)]
)
def test_margin_is_the_way_to_the_edge(point: tuple[float, float], margin: float) -> None:
    assert SupportRegion.hull(SQUARE).margin(np.array(point)) == pytest.approx(margin)


def test_the_nearest_point_of_what_is_in_is_itself() -> None:
    square = SupportRegion.hull(SQUARE)
    assert square.nearest(np.array([0.3, 0.4])) == pytest.approx([0.3, 0.4])
    assert square.nearest(np.array([2.0, 0.4])) == pytest.approx([1.0, 0.4])


def test_one_foot_is_a_circle_and_two_are_a_capsule() -> None:
    one = SupportRegion.capsule(np.array([[0.0, 0.05]]), 0.06)
    assert one.margin(np.array([0.0, 0.05])) == pytest.approx(0.06, rel=0.01)
    two = SupportRegion.capsule(np.array([[0.0, 0.05], [0.0, -0.05]]), 0.06)
    assert two.margin(np.zeros(2)) == pytest.approx(0.06, rel=0.01)
    assert two.margin(np.array([0.0, 0.12])) == pytest.approx(-0.01, abs=1e-3)


def test_in_the_air_everything_is_outside() -> None:
    assert SupportRegion.hull(np.zeros((0, 3))).margin(np.zeros(2)) == -np.inf


def test_soles_rounded_off_are_circles_of_their_size() -> None:
    both = SupportRegion.rounded([SQUARE, SQUARE + np.array([0.0, 3.0, 0.0])])
    radius = 1.0 / np.sqrt(np.pi)
    assert both.margin(np.array([0.5, 2.0])) == pytest.approx(radius, rel=0.01)
    assert both.margin(np.array([0.5, -0.5])) == pytest.approx(radius - 1.0, rel=0.01)
    alone = SupportRegion.rounded([SQUARE])
    assert alone.shape.area == pytest.approx(1.0, rel=0.01)
