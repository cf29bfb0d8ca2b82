"""Whatever raises, all that an emulated bus has opened is closed, and the first error is raised."""

from pathlib import Path

import pytest

from windup.hal.errors import PortError, UnknownNameError
from windup.sim_twin.wire import find_world
from windup.sim_twin.wire.serve.trace import TraceError
from windup.tools.testing.servo_bus import ServoBus


class Spoilt:
    """An open SDK port or robot that notes its end, and fails in it if it has an error."""

    def __init__(self, error: Exception | None = None) -> None:
        self.error, self.closed = error, False

    @property
    def stack(self) -> "Spoilt":
        return self

    def close(self) -> None:
        self.closed = True
        if self.error is not None:
            raise self.error

    closePort = close  # noqa: N815 - the SDK's name


def trace(path: Path) -> Path:
    """Return the trace of one ping."""
    with ServoBus(servos="STS3215:1") as bus, bus.serial() as port:
        bus.record(path)
        port.write(bytes.fromhex("FF FF 01 02 01 FB"))
        port.read(6)
    return path


def test_after_an_error_ports_and_recorders_are_closed_too(tmp_path: Path) -> None:
    path = tmp_path / "ping.trace"
    with pytest.raises(ValueError, match="mine"), ServoBus(servos="XM430-W350:1") as bus:
        port = bus.open_sdk("dynamixel")
        bus.record(path)
        bus.wait(0.1)
        raise ValueError("mine")
    assert not port.is_open
    assert path.read_text().startswith("# windup trace")
    with pytest.raises(UnknownNameError):
        find_world(bus._name)


def test_after_an_error_the_robot_is_disconnected() -> None:
    with pytest.raises(ValueError, match="mine"), ServoBus("op3", physics="inertia") as bus:
        bus._robots.append(robot := Spoilt())  # type: ignore[arg-type]
        raise ValueError("mine")
    assert robot.closed


def test_a_trace_that_is_not_finished_does_not_hide_the_error(tmp_path: Path) -> None:
    path = trace(tmp_path / "ping.trace")
    with pytest.raises(ValueError, match="mine") as caught, ServoBus(servos="STS3215:1") as bus:
        bus.check(path)
        raise ValueError("mine")
    assert "fewer bytes than" in caught.value.__notes__[0]
    with (
        pytest.raises(ValueError, match="mine") as caught,
        ServoBus.replay(path),
    ):
        raise ValueError("mine")
    assert len(caught.value.__notes__) == 1
    with pytest.raises(TraceError), ServoBus.replay(path):
        pass


def test_the_first_of_several_errors_is_raised_and_all_is_closed(tmp_path: Path) -> None:
    bus = ServoBus(servos="STS3215:1")
    bus.check(trace(tmp_path / "ping.trace"))
    ports = [Spoilt(PortError("the first")), Spoilt(PortError("the second")), Spoilt()]
    bus._sdk_ports += ports
    with pytest.raises(PortError, match="the first") as caught:
        bus.close()
    assert all(port.closed for port in ports)
    second, third = caught.value.__notes__
    assert second.endswith("the second") and "fewer bytes than" in third
    with pytest.raises(UnknownNameError):
        find_world(bus._name)
    bus.close()
