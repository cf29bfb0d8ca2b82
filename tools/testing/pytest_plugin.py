"""Fixtures for tests of programs that speak to servos; installed with the package.

def test_it_finds_its_servos(servo_bus):
    bus = servo_bus(servos="XM430-W350:1-3")
    port = bus.open_sdk("dynamixel")
    assert my_arm.find(port) == [1, 2, 3]

def test_it_survives_dropouts(servo_bus):
    bus = servo_bus("op3", seed=1)
    bus.faults.drop(ids=[7], rate=0.02).delay(0.016).corrupt(rate=0.001)
    robot = bus.robot()
    robot.stand(2.0)
    assert not robot.fallen and robot.loop.missed == 0

Every run of pytest imports this file, so it imports nothing of ours before a fixture is asked for.
"""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import pytest

if TYPE_CHECKING:
    from typing import Unpack

    from windup.tools.testing.bus_options import BusOptions
    from windup.tools.testing.servo_bus import ServoBus
    from windup.tools.testing.servo_pty import ServoPty


class MakeServoBus(Protocol):
    """What the fixture `servo_bus` is; annotate a test's argument with it for completion."""

    def __call__(self, robot: str | Path = "bench", **options: "Unpack[BusOptions]") -> "ServoBus":
        """Return emulated buses on a virtual clock; they are closed when the test ends."""
        ...


class MakeServoPty(Protocol):
    """What the fixture `servo_pty` is; annotate a test's argument with it for completion."""

    def __call__(
        self,
        robot: str | Path = "bench",
        *,
        path: str | Path | None = None,
        **options: "Unpack[BusOptions]",
    ) -> "ServoPty":
        """Return emulated buses on pseudo-terminals; they are closed when the test ends."""
        ...


@pytest.fixture
def servo_bus() -> Iterator[MakeServoBus]:
    """Make an emulated servo bus: ``servo_bus(servos="STS3215:1-6")``; see `ServoBus`."""
    from windup.tools.testing.servo_bus import ServoBus

    with ExitStack() as stack:

        def make(robot: str | Path = "bench", **options: "Unpack[BusOptions]") -> ServoBus:
            bus = ServoBus(robot, **options)
            stack.callback(bus.close)
            return bus

        yield make


@pytest.fixture
def servo_pty() -> Iterator[MakeServoPty]:
    """Serve emulated servos under a path: ``servo_pty(servos="STS3215:1-6").path``."""
    from windup.tools.testing.servo_pty import ServoPty

    with ExitStack() as stack:

        def make(
            robot: str | Path = "bench",
            *,
            path: str | Path | None = None,
            **options: "Unpack[BusOptions]",
        ) -> ServoPty:
            return stack.enter_context(ServoPty(robot, path=path, **options))

        yield make


@pytest.fixture
def servo_replay() -> "Iterator[Callable[[str | Path], ServoBus]]":
    """Make a bus that answers from a trace: ``servo_replay("walk.trace")``."""
    from windup.tools.testing.servo_bus import ServoBus

    with ExitStack() as stack:

        def make(path: str | Path) -> ServoBus:
            bus = ServoBus.replay(path)
            stack.callback(bus.close)
            return bus

        yield make
