"""The buttons of an OpenCR: a press is seen once, with its name."""

import pytest

from tests.hal.backend_robot import Robot
from windup.hal.imu.opencr import OpenCr


def pressing(robot: Robot, buttons: int) -> tuple[str | None, tuple[str, ...]]:
    """Return what is seen once these bits of the board's register are set."""
    robot.serial.put(200, 30, buttons, 1)
    robot.backend.read()
    return robot.backend.button.pressed, robot.backend.button.held


@pytest.mark.parametrize(
    ("bits", "name"), [(0x01, "mode"), (0x02, "start"), (0x04, "user"), (0x08, "reset")]
)
def test_each_button_has_its_bit(bits: int, name: str) -> None:
    robot = Robot(board=OpenCr("body")).up()
    assert pressing(robot, 0) == (None, ())
    assert pressing(robot, bits) == (name, (name,))


def test_a_press_stays_known_when_the_button_is_let_go() -> None:
    robot = Robot(board=OpenCr("body")).up()
    pressing(robot, 4)
    assert pressing(robot, 0) == ("user", ())


def test_a_button_that_is_down_when_torque_comes_on_is_no_press_until_it_is_pressed_anew() -> None:
    robot = Robot(board=OpenCr("body")).up()
    pressing(robot, 1)
    robot.backend.set_torque(True)
    assert pressing(robot, 1) == (None, ("mode",))
    assert pressing(robot, 3) == ("start", ("mode", "start"))
    robot.backend.set_torque(True)
    pressing(robot, 0)
    assert pressing(robot, 1) == ("mode", ("mode",))


def test_a_board_that_does_not_answer_says_nothing_new() -> None:
    robot = Robot(board=OpenCr("body")).up()
    robot.serial.silent.add(200)
    assert pressing(robot, 1) == (None, ())
