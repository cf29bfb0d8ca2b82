"""Fixtures for tests of programs that speak to servos; installed with the package.

def test_survives_dropout(servo_bus):
    bus = servo_bus("op3", physics="mujoco", seed=1)
    bus.faults.drop(ids=[7], rate=0.02).delay(0.016).corrupt(rate=0.001)
    robot = bus.robot()
    robot.stand()
    robot.run(2.0)
    assert not robot.fallen and robot.loop.missed == 0
"""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from windup.tools.testing.servo_bus import ServoBus


@pytest.fixture
def servo_bus() -> "Iterator[Callable[..., ServoBus]]":
    """Make a robot's emulated servo bus: ``servo_bus("op3", seed=1)``; see `ServoBus`."""
    from windup.tools.testing.servo_bus import ServoBus  # not before a test asks: it takes a second

    made: list[ServoBus] = []

    def make(robot: str, **options: str | float) -> ServoBus:
        made.append(ServoBus(robot, **options))  # type: ignore[arg-type]
        return made[-1]

    yield make
    for bus in made:
        bus.close()


@pytest.fixture
def servo_replay() -> "Iterator[Callable[[str | Path], ServoBus]]":
    """Make a bus that answers from a trace: ``servo_replay("walk.trace")``."""
    from windup.tools.testing.servo_bus import ServoBus

    made: list[ServoBus] = []

    def make(path: str | Path) -> ServoBus:
        made.append(ServoBus.replay(path))
        return made[-1]

    yield make
    for bus in made:
        bus.close()
