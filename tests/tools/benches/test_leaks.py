import gc
import os
import weakref
from collections.abc import Iterator

import pytest

from windup.hal.errors import WindupError
from windup.hal.telemetry.runtime_folder import runtime_folder
from windup.robots import load_robot
from windup.sim_twin.environment import Environment
from windup.sim_twin.ground.terrain import Ground
from windup.sim_twin.wire.world.worlds import _running
from windup.tools.benches.leaks import COUNTED, Resources, clean, leaks, open_once
from windup.tools.robot.robot import Robot
from windup.tools.robot.stack import torque_off


@pytest.fixture
def no_collector() -> Iterator[None]:
    gc.collect()
    gc.disable()
    yield
    gc.enable()


@pytest.mark.usefixtures("no_collector")
@pytest.mark.parametrize("port", [None, "twin://op3"])
def test_a_closed_robot_is_freed_at_once(port: str | None) -> None:
    robot = Robot.open("op3", port=port)
    robot.stand(0.05)
    robot.stop(limp=True)
    robot.close()
    robot_gone, twin_gone = weakref.ref(robot), weakref.ref(robot.twin)
    del robot
    assert robot_gone() is None and twin_gone() is None


@pytest.mark.parametrize("port", [None, "twin://duck"])
def test_opening_a_robot_leaves_nothing(port: str | None) -> None:
    open_once("duck", port)
    worlds = len(_running)
    row = leaks("duck", port, 3)
    # Fewer is fine: what another test has left may go meanwhile.
    assert all(row[name] <= 0 for name in COUNTED)
    assert len(_running) == worlds


def test_a_robot_that_cannot_be_opened_leaves_no_world() -> None:
    worlds = len(_running)
    for port in ("twin://op3?faults=drop:1", "twin://op3?bus=tail", "twin://op3?baud=57600"):
        with pytest.raises(WindupError):
            Robot.open("op3", port=port, world=Environment(Ground(slope=1.0)))
    torque_off(load_robot("op3"), "twin://op3")
    assert len(_running) == worlds


def test_what_is_left_is_seen() -> None:
    before = Resources.now()
    read, write = os.pipe()
    (runtime_folder() / "left.ring").touch()
    row = Resources.now().since(before)
    for descriptor in (read, write):
        os.close(descriptor)
    (runtime_folder() / "left.ring").unlink()
    assert (row["descriptors"], row["files"]) == (2, 1)
    assert not clean(row)


@pytest.mark.parametrize(("changed", "good"), [
    ({}, True),
    ({"memory_grown_mb": 5.1}, False),
    ({"threads": 1}, False),
    ({"processes": -1}, True),
])  # fmt: skip
def test_limits(changed: dict[str, float], good: bool) -> None:
    row = {"memory_grown_mb": 0.4, "descriptors": 0, "threads": 0, "processes": 0, "files": 0}
    assert clean({**row, **changed}) is good
