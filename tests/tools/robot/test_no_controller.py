"""`Robot.run` with what is no controller, or with no valid time."""

from typing import Any

import pytest

from windup import Robot
from windup.control.motions.play import PoseHolder
from windup.hal.errors import ControllerError, UsageError
from windup.hal.observation import Observation


class OnlyReset:
    def reset(self, observation: Observation) -> None:
        """Do nothing."""


class Empty(OnlyReset):
    def step(self, observation: Observation, dt: float) -> Any:
        """Return nothing."""


WRONG = {
    "none": (None, "not NoneType: it has no reset(observation)"),
    "class": (Empty, "not the class Empty: give Empty(...)"),
    "no step": (OnlyReset(), "not OnlyReset: it has no step(observation, dt)"),
}


@pytest.mark.parametrize(("wrong", "said"), WRONG.values(), ids=WRONG)
def test_what_is_no_controller_is_refused_before_anything_moves(wrong: Any, said: str) -> None:
    with Robot.open("op3") as robot:
        with pytest.raises(UsageError) as error:
            robot.run(wrong, seconds=0.1)
        assert str(error.value) == f"robot.run() takes a controller, {said}"
        assert robot.loop.ticks == 0


def test_a_time_below_zero_is_refused() -> None:
    with Robot.open("op3") as robot:
        holder = PoseHolder(robot.joints, robot.description.stance)
        with pytest.raises(UsageError, match=r"^seconds -1: give 0 .. "):
            robot.run(holder, seconds=-1)
        with pytest.raises(UsageError, match=r"^seconds -1: give 0 .. "):
            robot.ticks(-1)


@pytest.mark.parametrize("port", [None, "twin://op3?clock=virtual"], ids=["twin", "wire"])
def test_a_step_that_returns_nothing_is_told(port: str | None) -> None:
    said = r"^Empty.step returned nothing; it should return JointCommand.of\(joints, position"
    with pytest.raises(ControllerError, match=said), Robot.open("op3", port=port) as robot:
        robot.run(Empty(), seconds=0.1)
