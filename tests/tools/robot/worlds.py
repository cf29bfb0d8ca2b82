"""Robots for the tests of ticks, reads and writes: on the twin, and on emulated servos."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

from windup import JointCommand, Robot
from windup.tools.testing.servo_bus import ServoBus

HEAD = "head_pan"


@contextmanager
def on_the_twin(name: str = "op3") -> Iterator[Robot]:
    with Robot.open(name) as robot:
        yield robot


@contextmanager
def on_servos(name: str = "op3") -> Iterator[Robot]:
    with ServoBus(name) as bus, bus.robot() as robot:
        yield robot


WORLDS: dict[str, Callable[[], AbstractContextManager[Robot]]] = {
    "twin": on_the_twin,
    "wire": on_servos,
}


def turned(robot: Robot, angle: float) -> JointCommand:
    """Return the stance with the last joint of the head, or another one, turned to `angle` rad."""
    goal = robot.description.stance.copy()
    goal[index(robot)] = angle
    return JointCommand.of(robot.joints, position=goal)


def head(robot: Robot) -> float:
    """Return where that joint is, rad."""
    return float(robot.backend.peek().joints.position[index(robot)])


def index(robot: Robot) -> int:
    names = robot.joints.names
    return names.index(HEAD) if HEAD in names else len(names) - 1
