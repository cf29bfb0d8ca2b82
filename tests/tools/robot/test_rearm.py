import numpy as np
import pytest

from windup.control.motions.play import PoseHolder
from windup.hal.errors import PortError, StaleStateError, UsageError
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.tools.robot.robot import Robot


def unplugged(seconds: float) -> Robot:
    """Return a duck whose adapter was pulled out while it stood."""
    faults = f"unplug:at=2.5:seconds={seconds:g}:bus=body"
    duck = Robot.open("duck", port=f"twin://duck?faults={faults}")
    with pytest.raises(PortError, match=r"no joint can be reached: port .* was disconnected"):
        duck.stand(5.0)
    return duck


def test_a_duck_that_was_unplugged_stays_limp_until_it_is_armed_again() -> None:
    duck = unplugged(0.5)
    servos = duck.backend.backend
    assert isinstance(servos, ServoBackend)
    duck.backend.clock.wait_until(duck.backend.clock.now() + 1.0)
    for _ in range(5):  # opened, switched off, believed
        servos.read()
    assert servos.lost == {} and servos.links[0].torque.state().all_off
    duck.rearm()
    assert duck.armed
    line = servos.readouts[0]
    goals, _ = line.bus.sync_read(line.ids, line.bus.family.registers["goal_position"])
    here = duck.backend.read().joints.position
    np.testing.assert_allclose(servos.units.angle(goals.astype(float)), here, atol=0.2)
    withheld = servos.clamps["unarmed"]
    report = duck.run(PoseHolder(duck.description.joints, here), 0.5, down=True)  # as it lies
    assert report.reason == "done"
    assert servos.clamps["unarmed"] == withheld
    duck.rest()
    assert not duck.armed
    duck.close()


def test_a_port_that_comes_back_a_little_later_is_waited_for() -> None:
    duck = unplugged(1.0)
    duck.rearm()
    assert duck.armed and duck.backend.backend.lost == {}  # type: ignore[attr-defined]
    duck.stop(limp=True)
    duck.close()


def test_a_port_that_stays_away_is_said() -> None:
    duck = unplugged(60.0)
    with pytest.raises(PortError, match=r"cannot arm again: .*was disconnected"):
        duck.rearm()
    with pytest.raises(
        StaleStateError, match="was disconnected"
    ):  # nobody knows whether torque is off
        duck.close()


def test_a_twin_without_a_wire_has_nothing_to_arm() -> None:
    with Robot.open("duck") as duck:
        duck.rearm()
        assert not duck.armed


def test_a_robot_that_may_not_move_may_not_be_armed_again() -> None:
    with Robot.open("duck", port="twin://duck") as duck:
        object.__setattr__(duck.stack, "may_arm", False)
        with pytest.raises(UsageError, match="give --arm"):
            duck.rearm()
