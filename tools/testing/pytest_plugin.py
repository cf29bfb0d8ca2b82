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

Every run of pytest imports this file, so the fixtures import the rest when they are used.
"""

from collections.abc import Callable, Generator, Iterator
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
    """Type of the fixture `servo_bus`; annotate a test's argument with it for completion."""

    def __call__(self, robot: str | Path = "bench", **options: "Unpack[BusOptions]") -> "ServoBus":
        """Return emulated buses on a virtual clock; the fixture closes them after the test."""
        ...


class MakeServoPty(Protocol):
    """Type of the fixture `servo_pty`; annotate a test's argument with it for completion."""

    def __call__(
        self,
        robot: str | Path = "bench",
        *,
        path: str | Path | None = None,
        **options: "Unpack[BusOptions]",
    ) -> "ServoPty":
        """Return emulated buses on pseudo-terminals; the fixture closes them after the test."""
        ...


FAILED = pytest.StashKey[bool]()
"""Whether a test has failed, for its fixtures."""


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item,
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Note that a test has failed."""
    report = yield
    item.stash[FAILED] = item.stash.get(FAILED, False) or report.failed
    return report


@pytest.fixture
def servo_bus(request: pytest.FixtureRequest) -> Iterator[MakeServoBus]:
    """Return a function that makes an emulated servo bus: ``servo_bus(servos="STS3215:1-6")``."""
    from windup.tools.testing.servo_bus import ServoBus

    with ExitStack() as stack:

        def make(robot: str | Path = "bench", **options: "Unpack[BusOptions]") -> ServoBus:
            bus = ServoBus(robot, **options)
            stack.callback(close, bus)
            return bus

        def close(bus: ServoBus) -> None:
            failed = request.node.stash.get(FAILED, False)
            (bus.drop_golden if failed else bus.close)()

        yield make


@pytest.fixture
def servo_pty() -> Iterator[MakeServoPty]:
    """Return a function that serves servos: ``servo_pty(servos="STS3215:1-6").path``."""
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
    """Return a function that replays a trace as a bus: ``servo_replay("walk.trace")``."""
    from windup.tools.testing.servo_bus import ServoBus

    with ExitStack() as stack:

        def make(path: str | Path) -> ServoBus:
            bus = ServoBus.replay(path)
            stack.callback(bus.close)
            return bus

        yield make
