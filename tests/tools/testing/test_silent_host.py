"""A program that sends nothing for a while: what servos with a Bus Watchdog make of it."""

import numpy as np

from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.tools.testing.servo_bus import ServoBus


def test_op3_freezes_with_torque_on_and_goes_on_when_its_host_is_back() -> None:
    with ServoBus("op3", seed=1) as bus:
        robot = bus.robot()
        robot.stand(1.0)
        servos = robot.backend.backend
        assert isinstance(servos, ServoBackend)
        (link,) = servos.links
        bus.wait(1.0)
        assert sum(device.driving for device in bus.world.devices) == 20
        registers = link.readout.bus.family.registers
        counts, valid = link.readout.bus.sync_read(link.readout.ids, registers["bus_watchdog"])
        assert valid.all() and (counts == -1).all()
        assert link.torque.state().all_on

        assert robot.stand(1.0).reason == "done"
        assert servos.watchdog_trips == 20 and not robot.fallen
        np.testing.assert_allclose(
            robot.backend.read().joints.position, robot.description.stance, atol=0.1
        )
