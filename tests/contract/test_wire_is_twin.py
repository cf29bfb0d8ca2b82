"""What goes over an emulated wire goes the way of the twin without one."""

import numpy as np
import pytest

import windup.sim_twin.wire as wire
from tests.contract.probing import COUNT, TICK, wired
from windup.hal.backend import Backend
from windup.hal.command import JointCommand
from windup.hal.joints import Array
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.robots import load_robot
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.twin import Twin


def way(backend: Backend, swing: float) -> Array:
    """Stand and swing the arms freely; return the positions (ticks, n) that were read, rad."""
    backend.connect()
    backend.configure()
    backend.set_torque(True)
    joints, stance = backend.joints, load_robot("op3").stance
    behind(backend).reset(stance)  # it has sunk a little while one servo after the other came on
    arms = np.array(["sho" in name or "el" in name for name in joints.names])
    began, seen = backend.clock.now(), []
    for tick in range(150):
        pose = stance + swing * arms * np.sin(2.0 * np.pi * 0.5 * tick * TICK)
        backend.write(JointCommand.hold(joints, pose))
        backend.clock.wait_until(began + (tick + 1) * TICK)
        seen.append(backend.read().joints.position)
    backend.disconnect()
    return np.array(seen)


def behind(backend: Backend) -> Twin:
    """Return the twin behind a backend, on a wire or not."""
    if isinstance(backend, TwinBackend):
        return backend.twin
    assert isinstance(backend, ServoBackend)
    world = wire.find_world(backend.links[0].bus.port.url.split("world=")[1].split("&")[0])
    return next(item for item in world.owned if isinstance(item, Twin))


@pytest.mark.parametrize(("swing", "counts"), [(0.0, 1.0), (0.1, 1.0)])
def test_the_wire_and_the_twin_go_the_same_way(swing: float, counts: float) -> None:
    # A goal takes the wire about one physics step, and is read back half a cycle late.
    bus = way(wired("op3"), swing)
    twin = way(TwinBackend(Twin(load_robot("op3"), delay=0.002)), swing)
    assert np.abs(bus - twin).max() <= (counts + 1e-6) * COUNT
