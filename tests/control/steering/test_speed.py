from pathlib import Path

import numpy as np
import pytest

from tests.small_world import gait
from windup.control.steering.speed import SpeedControl
from windup.hal.errors import UsageError

GAIT = """
title = "Speeds"
[[state]]
name = "A"
until = { time = 0.1 }
ends_step = true
[[perturbation]]
name = "stride"
pose = { l_hip = 1 }
[[perturbation]]
name = "lean"
pose = { waist = 1 }
"""

TABLE = """
[speed]
default = 0.1
ramp = 0.04
correct = "way"
gain = 0.5
limit = 0.03
rows = [
  { speed = 0.0, scale = { stride = 1.0 }, targets = { way = 0.0 } },
  { speed = 0.1, scale = { stride = 5.0, lean = 2.0 }, targets = { way = 0.05 } },
  { speed = 0.2, scale = { stride = 7.0, lean = 4.0 }, targets = { way = 0.10 } },
]
"""


def control(folder: Path, speed: float | None = None, text: str = GAIT + TABLE) -> SpeedControl:
    return SpeedControl(gait(folder, text), speed)


def after(subject: SpeedControl, steps: int) -> SpeedControl:
    for _ in range(steps):
        subject.begin_step()
    return subject


@pytest.mark.parametrize(
    ("speed", "stride", "way"), [(0.0, 1.0, 0.0), (0.05, 3.0, 0.025), (0.15, 6.0, 0.075)]
)
def test_scalings_and_targets_lie_on_lines_between_the_rows(
    tmp_path: Path, speed: float, stride: float, way: float
) -> None:
    subject = after(control(tmp_path, speed), 20)
    assert subject.scale()[0] == pytest.approx(stride)
    assert subject.targets() == {"way": pytest.approx(way)}


def test_a_value_that_some_rows_leave_out_is_that_of_the_nearest_row_that_has_it(
    tmp_path: Path,
) -> None:
    assert after(control(tmp_path, 0.0), 20).scale()[1] == 2.0
    assert after(control(tmp_path, 0.15), 20).scale()[1] == pytest.approx(3.0)


def test_the_speed_of_the_gait_holds_when_nobody_asks(tmp_path: Path) -> None:
    assert control(tmp_path).speed == 0.1


def test_speed_comes_up_a_ramp_step_by_step_and_stays(tmp_path: Path) -> None:
    subject = control(tmp_path, 0.1)
    seen = [after(subject, 1).present for _ in range(5)]
    np.testing.assert_allclose(seen, [0.04, 0.08, 0.1, 0.1, 0.1])
    subject.reset()
    assert subject.present == subject.correction == 0.0


def test_too_slow_a_step_raises_the_corrected_target_up_to_its_limit(tmp_path: Path) -> None:
    subject = after(control(tmp_path, 0.1), 20)
    subject.measured(0.08)
    assert subject.correction == pytest.approx(0.5 * 0.02)
    assert subject.targets()["way"] == pytest.approx(0.05 + 0.01)
    for _ in range(9):
        subject.measured(0.0)
    assert subject.correction == 0.03
    for _ in range(9):
        subject.measured(0.3)
    assert subject.correction == -0.03


@pytest.mark.parametrize("speed", [-0.01, 0.21, np.nan])
def test_a_speed_outside_the_table_says_the_range(tmp_path: Path, speed: float) -> None:
    with pytest.raises(UsageError) as error:
        control(tmp_path, speed)
    assert str(error.value) == (
        f"speed {speed:g} m/s is outside the range of gait 'test': 0 .. 0.2 m/s"
    )


def test_a_gait_without_a_table_takes_no_speed_and_asks_for_nothing(tmp_path: Path) -> None:
    subject = control(tmp_path, None, GAIT)
    subject.begin_step()
    subject.measured(1.0)
    np.testing.assert_array_equal(subject.scale(), [0.0, 0.0])
    assert subject.targets() == {}
    with pytest.raises(UsageError) as error:
        control(tmp_path, 0.1, GAIT)
    assert str(error.value) == (
        "gait 'test' has no speed table; leave --speed away or choose another --gait"
    )
