"""A robot on a wire, on another ground and with another plant."""

import numpy as np
import pytest

from windup.hal.errors import UsageError
from windup.robots import load_robot
from windup.sim_twin.environment import Environment
from windup.sim_twin.ground.terrain import Ground
from windup.sim_twin.plant import Plant
from windup.sim_twin.servo.servo_motor import KP
from windup.sim_twin.twin import Twin
from windup.sim_twin.wire.shafts.twin_shaft import TwinShaft
from windup.sim_twin.wire.world.address import parse_address
from windup.sim_twin.wire.world.build import build_world

OP3 = load_robot("op3")


def twin_of(around: Environment, url: str = "twin://op3") -> Twin:
    twin = build_world(parse_address(url), around).owned[0]
    assert isinstance(twin, Twin)
    return twin


def test_the_twin_behind_the_wire_stands_on_that_ground() -> None:
    assert twin_of(Environment(Ground(slope=3.0))).world.ground.slope == 3.0


def test_a_plants_servos_are_stiffer_and_have_its_supply() -> None:
    world = build_world(
        parse_address("twin://op3"), Environment(plant=Plant(stiffness=1.2, supply=10.8))
    )
    twin = world.owned[0]
    assert isinstance(twin, Twin)
    assert twin.supply == 10.8
    assert world.devices[0].supply == 10.8
    mount = OP3.servos[0]
    assert mount is not None
    TwinShaft(twin, 0, mount).hold_goal(0.0, 10.0, 10.8)
    assert twin.model.actuator_gainprm[0, KP] == pytest.approx(12.0)


@pytest.mark.parametrize(("delay", "left"), [(0.016, 0.012), (0.004, 0.0), (0.002, 0.0)])
def test_of_a_plants_delay_the_wire_takes_its_own_part(delay: float, left: float) -> None:
    assert twin_of(Environment(plant=Plant(delay=delay))).delay == pytest.approx(left)


def test_a_plants_mass_is_heavier() -> None:
    heavy, plain = twin_of(Environment(plant=Plant(mass=1.1))), twin_of(Environment())
    np.testing.assert_allclose(heavy.model.body_mass, 1.1 * plain.model.body_mass)


@pytest.mark.parametrize("url", ["twin://op3?physics=inertia", "twin://bench?servos=XM430-W350:1"])
def test_what_stands_on_no_ground_has_no_other_ground(url: str) -> None:
    with pytest.raises(UsageError, match="need a robot with physics=mujoco"):
        build_world(parse_address(url), Environment(Ground(slope=1.0)))
