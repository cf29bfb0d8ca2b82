from pathlib import Path

import numpy as np
import pytest

from windup.control.footprints.footprints import Footprint, read_footprints, write_footprints
from windup.control.kinematics.places import between, ground_places, onto, seen_from
from windup.hal.errors import WindupError

FEET = ("left_foot", "right_foot")
HERE, THERE = np.array([1.0, 2.0, 0.5]), np.array([0.3, -0.2, -2.0])


def test_a_place_seen_from_a_frame_and_put_onto_it_again_is_the_same() -> None:
    assert onto(HERE, seen_from(HERE, THERE)) == pytest.approx(THERE)


def test_a_quarter_turn_makes_forward_left() -> None:
    turned = np.array([0.0, 0.0, np.pi / 2])
    assert onto(turned, np.array([1.0, 0.0, 0.0])) == pytest.approx([0.0, 1.0, np.pi / 2])


def test_between_two_places_is_halfway_also_across_half_a_turn() -> None:
    one, other = np.array([0.0, 0.1, 3.0]), np.array([0.2, -0.1, -3.0])
    x, y, yaw = between(one, other)
    assert (x, y) == pytest.approx((0.1, 0.0))
    assert np.cos(yaw) == pytest.approx(-1.0)


def test_the_yaw_of_a_sole_is_that_of_its_x_axis() -> None:
    c, s = np.cos(0.4), np.sin(0.4)
    axes = np.array([[c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0]])
    places = ground_places(np.array([[1.0, 2.0, 3.0]]), axes)
    assert places[0] == pytest.approx([1.0, 2.0, 0.4])


def test_what_is_written_is_read_again(tmp_path: Path) -> None:
    prints = [
        Footprint(0, np.array([0.05, 0.12, 0.1]), "start", 0.7),
        Footprint(1, np.array([0.0, -0.1, 0.0]), "start"),
    ]
    path = tmp_path / "prints.toml"
    path.write_text(write_footprints(prints, FEET))
    read = read_footprints(path, FEET)
    assert [(one.foot, one.frame, one.duration) for one in read] == [
        (0, "start", 0.7),
        (1, "start", None),
    ]
    for one, other in zip(prints, read, strict=True):
        assert other.place == pytest.approx(one.place, abs=1e-3)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("step = []", "it has no step; give at least one [[step]]"),
        ('[[step]]\nfoot = "lift"\nx = 0\ny = 0', "step 1: unknown foot 'lift'"),
        ('[[step]]\nfoot = "left"\nx = inf\ny = 0', "step[0].x: inf is not finite"),
        (
            '[[step]]\nfoot = "left"\nx = 0\ny = 0\nduration = 0',
            "step[0].duration: Expected `float` > 0.0",
        ),
        ('[[step]]\nfoot = "left"\nx = 0\nz = 0', "unknown key"),
        ('frame = "world"\nstep = []', "frame"),
    ],
)
def test_what_is_wrong_in_a_file_is_said(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "prints.toml"
    path.write_text(text)
    with pytest.raises(WindupError) as caught:
        read_footprints(path, FEET)
    assert said in str(caught.value)
    assert caught.value.exit_status == 2
