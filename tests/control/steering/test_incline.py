import numpy as np
import pytest

from windup.control.pose_graph.gait_file import Incline
from windup.control.regulation.step_record import StepRecord
from windup.control.steering.incline import InclineControl

LAW = Incline(perturbation="incline", gain=40.0, limit=5.0)


def record(target: float, measured: float) -> StepRecord:
    regulation, wanted = np.array([9.0, measured]), np.array([-9.0, target])
    return StepRecord(1.0, 0.25, np.zeros(3), 0.0, 0.2, 0.0, regulation, wanted, np.zeros(2))


@pytest.mark.parametrize(
    ("measured", "tilt"), [(0.06, 0.0), (-0.04, 4.0), (0.11, -2.0), (-0.5, 5.0), (0.5, -5.0)]
)
def test_the_soles_tilt_by_what_the_lean_misses_and_no_further(
    measured: float, tilt: float
) -> None:
    incline = InclineControl(LAW, column=1)
    for _ in range(100):
        incline.measured(record(0.06, measured))
    assert incline.present == pytest.approx(tilt, abs=1e-3)
    incline.reset()
    assert incline.present == 0.0


def test_one_odd_step_tilts_them_a_little() -> None:
    incline = InclineControl(LAW, column=1)
    incline.measured(record(0.06, -0.04))
    assert incline.present == pytest.approx(0.4)
