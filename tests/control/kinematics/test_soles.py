import mujoco
import numpy as np
import pytest

from tests.control.biped import CONTACTS, GRAVITY, model, soles
from windup.control.estimation.foot_load import FootLoad
from windup.control.kinematics.soles import Soles, cross, spin
from windup.hal.contacts import ContactSensors
from windup.hal.errors import UsageError

UP = np.array([0.0, 0.0, 1.0])
REST = np.array([0.0, 0.0, GRAVITY])


def test_a_box_has_eight_corners_each_with_its_nearest_sensor() -> None:
    feet = soles()
    feet.update(np.zeros(2), np.zeros(2), UP)
    assert feet.members.sum(axis=1).tolist() == [8.0, 8.0]
    assert feet.heights.min() == pytest.approx(-0.25)
    toes = feet.position[:, 0] > 0.0
    names = np.array(CONTACTS.names)[feet.sensor]
    assert all(name.endswith("toe") == toe for name, toe in zip(names, toes, strict=True))


def test_flow_is_the_derivative_of_the_points() -> None:
    feet = soles()
    q, dq, step = np.array([0.3, -0.2]), np.array([2.0, 1.0]), 1e-6
    weights = np.random.default_rng(1).uniform(size=16)
    feet.update(q + step * dq, dq, UP)
    after = feet.flow(weights)[0]
    feet.update(q, dq, UP)
    before, flow = feet.flow(weights)
    assert flow == pytest.approx((after - before) / step, abs=1e-4)
    assert feet.rotation[:, 1] == pytest.approx(dq)


@pytest.mark.parametrize(
    ("geom", "points", "lowest"),
    [
        ('type="sphere" size="0.02"', 1, -0.02),
        ('type="capsule" size="0.01 0.05"', 2, -0.06),
        ('type="box" size="0.01 0.02 0.03"', 8, -0.03),
    ],
)
def test_round_soles_touch_below_their_centre(geom: str, points: int, lowest: float) -> None:
    ball = mujoco.MjModel.from_xml_string(
        f'<mujoco><worldbody><body name="foot"><freejoint/><geom {geom}/></body></worldbody>'
        "</mujoco>"
    )
    feet = Soles(ball, ["foot"], ContactSensors((), {"foot": ()}))
    feet.update(np.zeros(0), np.zeros(0), UP)
    assert len(feet.foot) == points
    assert feet.heights.min() == pytest.approx(lowest)


def test_a_foot_that_cannot_touch_is_an_error() -> None:
    with pytest.raises(UsageError, match="foot 'base' has no box, sphere or capsule"):
        Soles(model(), ["base"], ContactSensors((), {"base": ()}))


def test_shares_follow_the_sensors() -> None:
    feet = soles()
    feet.update(np.zeros(2), np.zeros(2), UP)
    load = FootLoad(feet, CONTACTS, 12.0)
    shares = load.shares(np.array([9.0, 3.0, 0.0, 0.5]), REST)
    assert shares.sum() == pytest.approx(1.0)
    assert feet.members @ shares == pytest.approx([1.0, 0.0])
    assert shares[feet.sensor == 0].sum() == pytest.approx(0.75)
    assert not load.shares(np.zeros(4), REST).any()


def test_without_sensors_the_lowest_edge_bears_the_weight() -> None:
    feet = soles()
    feet.update(np.full(2, 0.3), np.zeros(2), UP)  # toes down
    load = FootLoad(feet, CONTACTS, 12.0, sensed=False)
    shares = load.shares(np.zeros(4), REST)
    toes = feet.position[:, 0] > 0.0
    assert shares[toes].sum() > 0.99
    assert load.forces(shares) == pytest.approx([6.0, 0.0, 6.0, 0.0], abs=0.1)
    assert not load.shares(np.zeros(4), 0.1 * REST).any()


def test_cross_and_spin_are_the_vector_product() -> None:
    a, b = np.random.default_rng(2).normal(size=(2, 5, 3))
    assert cross(a, b) == pytest.approx(np.cross(a, b))
    assert b @ spin(a[0]).T == pytest.approx(np.cross(a[0], b))
