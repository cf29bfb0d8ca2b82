"""The driver of hal on the emulated wire of the duck: two readings of one manual meet."""

from itertools import pairwise

import numpy as np
import pytest

from windup.hal.command import JointCommand
from windup.hal.servo_bus.servo_backend import BusPort, ServoBackend
from windup.robots import load_robot
from windup.sim_twin.twin import Twin
from windup.tools.testing.servo_bus import ServoBus

PERIOD = 0.008
TICKS = 250


@pytest.mark.parametrize("faults", ["", "drop:0.01,corrupt:0.01,noise:0.01,cut:0.01"])
def test_the_duck_stands_on_its_wire(faults: str) -> None:
    robot = load_robot("duck")
    mounts = [mount for mount in robot.servos if mount is not None]
    with ServoBus("duck", seed=1, faults=faults) as bus:
        port = BusPort(f"{bus.url}&bus=body", robot.buses[0].baud)
        backend = ServoBackend(robot.joints, mounts, {"body": port}, supply=robot.drive.supply)
        backend.connect()
        backend.configure()
        assert backend.set_torque(True).all_on
        block = np.zeros((5, len(mounts)))
        block[0], block[3] = robot.stance, robot.joints.stiffness
        oldest = 0.0
        for tick in range(TICKS):
            seen = backend.read().joints
            if tick > 3:  # while torque was switched nobody read
                oldest = max(oldest, float(seen.age.max()))
            backend.write(JointCommand(block))
            backend.clock.wait_until(max(backend.clock.now(), (tick + 1) * PERIOD))
        (twin,) = bus.world.owned
        assert isinstance(twin, Twin)
        assert not twin.fallen
        assert oldest < 6 * PERIOD
        assert np.abs(seen.position - robot.stance).max() < 0.1
        assert backend.set_torque(False).all_off
        backend.disconnect()


def test_its_imu_has_a_port_of_its_own() -> None:
    with ServoBus("duck") as bus:
        assert list(bus.world.buses) == ["body", "imu"]
        with bus.serial("imu", 115_200, timeout=0.1) as port:
            frames = [port.read(19) for _ in range(5)]
    assert all(after[2] - before[2] == 1 for before, after in pairwise(frames))
    gravity = np.frombuffer(frames[-1][9:15], "<i2") * 1e-3
    assert gravity == pytest.approx([0.0, 0.0, 1.0], abs=0.01)  # held, and so at rest
