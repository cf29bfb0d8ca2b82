import numpy as np
import pytest

from tests.small_world import MIRROR
from windup.hal.mirror import other_side


@pytest.mark.parametrize(
    ("one", "other"),
    [("l_knee", "r_knee"), ("left_foot", "right_foot"), ("l_toe_out", "r_toe_out")],
)
def test_a_name_and_its_other_side_are_each_others(one: str, other: str) -> None:
    assert (other_side(one), other_side(other)) == (other, one)


@pytest.mark.parametrize("name", ["waist", "level", "relbow", "leftover"])
def test_a_name_without_a_side_is_its_own(name: str) -> None:
    assert other_side(name) == name


def test_the_mirror_image_swaps_sides_and_turns_signs() -> None:
    pose = np.array([0.1, 0.2, 0.3, 0.4, 0.5])
    np.testing.assert_array_equal(MIRROR(pose), [0.1, -0.4, 0.5, -0.2, 0.3])


def test_twice_mirrored_is_as_before_over_any_leading_axes() -> None:
    poses = np.random.default_rng(0).normal(size=(3, 4, 5))
    np.testing.assert_array_equal(MIRROR(MIRROR(poses)), poses)
