"""A rollout weighs what its twin weighs, wherever the MJCF has its masses from."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

from tests.shapes import SHAPES, Shape, write_shape
from windup.robots import load_robot
from windup.sim_twin.environment import Environment, build_model
from windup.sim_twin.masses import set_explicit_masses
from windup.sim_twin.plant import Plant


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.name)
def test_rollout_and_twin_have_the_same_masses_and_inertias(shape: Shape, tmp_path: Path) -> None:
    robot = load_robot(write_shape(tmp_path / "robot", shape))
    twin, bare = build_model(robot), build_model(robot, bare=True)
    assert bare.ngeom <= twin.ngeom
    for field in ("body_mass", "body_inertia", "body_ipos", "body_iquat"):
        np.testing.assert_array_equal(getattr(bare, field), getattr(twin, field))
    assert twin.body_mass.sum() == pytest.approx(robot.spec().compile().body_mass.sum())


def test_a_heavier_plant_is_heavier_with_masses_in_geoms(tmp_path: Path) -> None:
    robot = load_robot(write_shape(tmp_path / "robot", SHAPES[1]))
    heavy = build_model(robot, world=Environment(plant=Plant(mass=1.5)))
    plain = build_model(robot)
    np.testing.assert_allclose(heavy.body_mass, 1.5 * plain.body_mass)
    np.testing.assert_allclose(heavy.body_inertia, 1.5 * plain.body_inertia)


def test_full_inertias_are_scaled_too() -> None:
    robot = load_robot("robobird")
    heavy = build_model(robot, world=Environment(plant=Plant(mass=1.5)))
    np.testing.assert_allclose(heavy.body_inertia, 1.5 * build_model(robot).body_inertia)


@pytest.mark.filterwarnings("ignore:compiler attribute")
@pytest.mark.parametrize("geoms_win", ["auto", "true"])
@pytest.mark.parametrize("total", ["-1", "2"])
def test_what_the_compiler_decides_is_kept(geoms_win: str, total: str) -> None:
    text = f"""<mujoco><compiler inertiafromgeom="{geoms_win}" settotalmass="{total}"/><worldbody>
    <body name="a"><freejoint/><geom size="0.1" mass="0.3"/>
    <inertial mass="1" pos="0 0 0.1" diaginertia="1 1 1"/></body></worldbody></mujoco>"""
    wanted, spec = mujoco.MjSpec.from_string(text).compile(), mujoco.MjSpec.from_string(text)
    set_explicit_masses(spec)
    for geom in list(spec.geoms):
        spec.delete(geom)
    found = spec.compile()
    np.testing.assert_array_equal(found.body_mass, wanted.body_mass)
    np.testing.assert_array_equal(found.body_inertia, wanted.body_inertia)
