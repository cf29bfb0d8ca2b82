"""What comes before the first command to a robot on a port: how it is, and its first motion."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from windup.control.motions.play import PoseHolder
from windup.hal.errors import FirstMotionError, PostureError
from windup.sim_twin.servo.servo_motor import KP
from windup.sim_twin.wire.shafts.twin_shaft import TwinPhysics
from windup.tools.behaviours.rise import lay, rise
from windup.tools.robot.robot import Robot
from windup.tools.testing.servo_bus import ServoBus

BIPED = str(Path(__file__).parents[3] / "examples/biped")
"""A robot with ankles 2 cm above its soles."""


@pytest.fixture
def op3() -> Iterator[Robot]:
    with Robot.open("op3", port="twin://op3") as robot:
        yield robot


def physics_of(bus: ServoBus) -> TwinPhysics:
    assert isinstance(bus.world.physics, TwinPhysics)
    return bus.world.physics


def test_one_that_lies_is_told_before_torque_comes_on_and_can_get_up(op3: Robot) -> None:
    lay(op3, "front")
    there = r"op3 lies on its front: put it on its feet, or run `windup rise op3 --port twin://op3`"
    with pytest.raises(PostureError, match=there):
        op3.stand(1.0)
    assert not op3.armed
    report: dict[str, Any] = {"sides": [], "peak_load": 0.0, "up": False}
    rise(op3, 2, report)
    assert (report["up"], report["sides"]) == (True, ["front"])


def test_one_without_a_motion_for_it_is_only_told_to_be_put_up() -> None:
    with Robot.open("duck", port="twin://duck") as duck:
        lay(duck, "back")
        with pytest.raises(PostureError, match=r"^duck lies on its back: put it on its feet$"):
            duck.stand(1.0)


def test_one_whose_ankles_are_low_in_its_stance_does_not_sit() -> None:
    with ServoBus(BIPED) as bus, bus.robot() as robot:
        assert robot.stand(0.5).reason == "done"


def test_one_that_was_armed_lying_goes_limp_when_it_is_to_stand(op3: Robot) -> None:
    lay(op3, "back")
    op3.arm()
    assert op3.armed
    with pytest.raises(PostureError, match="lies on its back"):
        op3.stand(1.0)
    assert not op3.armed


def test_a_joint_outside_of_its_limits_is_named_before_its_goal_would_jump() -> None:
    with ServoBus("op3") as bus, bus.robot() as robot:
        joints, physics = robot.description.joints, physics_of(bus)
        robot.twin.data.qpos[7 + joints.index("r_knee")] = 0.6
        physics.store_held_pose()
        bus.wait(0.1)
        with pytest.raises(
            PostureError, match=r"r_knee reads 34 degrees, outside of its limits \(-126 \.\. 18\)"
        ):
            robot.run(PoseHolder(joints, robot.description.stance), 0.1, down=True)
        assert not robot.armed


def test_a_jammed_joint_makes_the_whole_robot_limp_at_once_and_is_named() -> None:
    with ServoBus("duck") as bus:
        robot = bus.robot()
        knee, physics = robot.description.joints.index("left_knee"), physics_of(bus)
        robot.twin.reset(0.7 * robot.description.stance)
        physics.store_held_pose()
        physics.jammed[knee] = True
        bus.wait(0.1)
        with pytest.raises(FirstMotionError, match="left_knee does not follow"):
            robot.stand(1.0)
        assert not robot.armed and robot.loop.sim_time < 1.5
        assert not any(device.driving for device in bus.world.devices)


def test_torque_comes_on_weak(op3: Robot) -> None:
    op3.arm()
    joints, gains = op3.description.joints, op3.twin.model.actuator_gainprm[:, KP]
    share = gains / joints.stiffness
    assert share[joints.index("l_knee")] == pytest.approx(0.6, abs=0.02)
    assert share[joints.index("l_el")] == pytest.approx(0.3, abs=0.02)


def test_the_time_of_a_run_counts_from_the_end_of_the_first_motion(op3: Robot) -> None:
    first = op3.stand(0.5).sim_time
    op3.start_in(op3.description.poses["walk_ready"])
    assert op3.stand(0.5).sim_time == pytest.approx(0.5, abs=0.02)
    assert first > 1.0


def test_a_robot_stands_stiff_after_it() -> None:
    with Robot.open("op3", port="twin://op3") as robot:
        robot.start_in(robot.description.poses["walk_ready"])
        assert robot.start is not None and not robot.start.motion.due
        np.testing.assert_allclose(
            robot.twin.model.actuator_gainprm[:, KP], robot.description.joints.stiffness, rtol=0.01
        )


def test_arming_again_has_a_first_motion_again(op3: Robot) -> None:
    assert op3.start is not None
    op3.start_in(op3.description.poses["walk_ready"])
    assert not op3.start.motion.due
    op3.rearm()
    assert op3.start.motion.due


def test_the_ideal_twin_has_no_first_motion() -> None:
    with Robot.open("op3") as robot:
        assert robot.start is None
        assert robot.stand(0.5).sim_time == pytest.approx(0.5, abs=0.01)
