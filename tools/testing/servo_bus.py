"""Emulated servo buses for tests, with faults, traces, SDK ports and the real driver.

with ServoBus(servos="STS3215:1-6") as bus:
    bus.faults.drop(ids=[3], rate=0.02)
    port = bus.open_sdk("feetech")  # a PortHandler of scservo_sdk
    bus.faults.overload(ids=[2])    # now

A bench of servos does not need MuJoCo, which is imported when a robot is used.
"""

import math
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from itertools import count
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final, Self, Unpack

import serial

from windup.hal.backend import Clock
from windup.hal.errors import UsageError
from windup.hal.port.open_port import open_port
from windup.hal.port.port import Port
from windup.hal.ranges import Range, check_number
from windup.sim_twin.wire import build_world, parse_address, register_world, unregister_world
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.faults.faults import Faults
from windup.sim_twin.wire.serve.trace import Checker, Recorder, Tap
from windup.sim_twin.wire.serve.trace_replay import check_played, replay_world
from windup.sim_twin.wire.world.address import BENCH
from windup.sim_twin.wire.world.bus_world import BusWorld
from windup.sim_twin.wire.world.clocks import VirtualClock
from windup.sim_twin.wire.world.hand import HandMotion
from windup.tools.testing.bus_options import BusOptions, bus_url
from windup.tools.testing.sdk_port import Sdk, port_handler_class

if TYPE_CHECKING:
    from windup.tools.robot.robot import Robot

_numbers = count(1)
WAIT: Final = Range(0.0, 1e9, "s")


class ServoBus:
    """The emulated buses of one robot, or servos on a bench, on a virtual clock.

    Time advances only in a read, in `wait`, or while a robot on these buses runs; `time.sleep` does
    not advance it.

    Args:
        robot: Name of a robot, path of its folder, or "bench" for `servos` without a robot.
        **options: Servos, baud rate, latency, supply, faults, seed: see `BusOptions`.

    Attributes:
        world: The world.
        clock: Its clock; it advances during waits.
        faults: The faults, one method for each kind.
        url: What to open: any pyserial program in this process can.
    """

    def __init__(self, robot: str | Path = BENCH, **options: Unpack[BusOptions]) -> None:
        self._robot, self._seed = str(robot), options.get("seed", 0)
        self._begin(build_world(parse_address(bus_url(robot, options))))

    @classmethod
    def replay(cls, path: str | Path) -> Self:
        """Return buses that answer from a trace; a host that sends other bytes is told so."""
        bus = cls.__new__(cls)
        bus._robot, bus._seed = "", 0
        bus._begin(replay_world(Path(path)))
        return bus

    def _begin(self, world: BusWorld) -> None:
        self.world = world
        self._name = f"servo-bus-{next(_numbers)}"
        register_world(self._name, world)
        self.clock: Clock = VirtualClock(world)
        self.faults: Faults = world.faults
        self.url = f"twin://{self._robot or 'tape'}?clock=virtual&world={self._name}"
        self._robots: list[Robot] = []
        self._sdk_ports: list[Any] = []
        self._taps: list[Tap] = []
        self._recorded: list[Path] = []

    def robot(self, **options: Any) -> "Robot":
        """Return the robot, opened with the real driver on these buses; see `Robot.open`.

        Raises:
            UsageError: This is a bench of servos or a trace, which has no robot.
        """
        if self._robot in ("", BENCH):
            what = "servos on a bench are" if self._robot else "a trace is"
            raise UsageError(f"{what} no robot; use port(), serial() or open_sdk()")
        from windup.tools.robot.robot import Robot  # imports MuJoCo, which a bench does not need

        robot = Robot.open(self._robot, port=self.url, **{"seed": self._seed, **options})
        self._robots.append(robot)
        return robot

    def port(self, bus: str = "", baud: int = 1_000_000) -> Port:
        """Return an open port of the driver on a bus, the first by default."""
        return open_port(self._url(bus), baud)

    def serial(self, bus: str = "", baud: int = 1_000_000, timeout: float = 0.02) -> Any:
        """Return an open pyserial port on a bus, the first by default."""
        return serial.serial_for_url(self._url(bus), baudrate=baud, timeout=timeout)

    def open_sdk(self, sdk: Sdk, bus: str = "", baud: int = 1_000_000) -> Any:
        """Return an open PortHandler of a maker's SDK on a bus.

        Packet handlers and groups of the SDK use it like any other, and virtual time advances while
        they wait::

            port = bus.open_sdk("dynamixel")
            model, result, error = dynamixel_sdk.PacketHandler(2.0).ping(port, 1)

        Args:
            sdk: "dynamixel" (dynamixel_sdk) or "feetech" (scservo_sdk).
            bus: Name of the bus; by default the first.
            baud: Baud rate, bits/s; one that the SDK supports.

        Raises:
            UsageError: The SDK is unknown or not installed, or does not support the baud rate.
        """
        port = self.port_handler(sdk, bus)(self._url(bus))
        if not port.setBaudRate(baud):
            raise UsageError(f"the {sdk} SDK does not support {baud} baud")
        self._sdk_ports.append(port)
        return port

    def port_handler(self, sdk: Sdk, bus: str = "") -> type[Any]:
        """Return a PortHandler class whose instances open a bus, whatever their port name is.

        This is for programs that create their PortHandler themselves::

            monkeypatch.setattr(my_arm, "PortHandler", bus.port_handler("feetech"))

        Args:
            sdk: "dynamixel" (dynamixel_sdk) or "feetech" (scservo_sdk).
            bus: Name of the bus; by default the first.

        Raises:
            UsageError: The SDK is unknown or not installed.
        """
        return port_handler_class(sdk, self._url(bus), self.clock)

    def servo(self, identifier: int, bus: str = "") -> Device:
        """Return an emulated servo.

        Raises:
            UsageError: There is none of this id.
        """
        for device in self.world.bus(bus).devices:
            if device.identifier == identifier:
                return device
        raise UsageError(f"there is no servo {identifier} on this bus")

    def hand(self, joint: str, degrees: float, seconds: float) -> None:
        """Have a hand turn a joint to and fro from now on, while its servo is limp.

        Args:
            joint: Its name; on a bench, the id of the servo.
            degrees: How far, from where it is.
            seconds: How long that takes.
        """
        self.world.hand(HandMotion(joint, math.radians(degrees), seconds))

    def wait(self, seconds: float) -> None:
        """Let `seconds` s of virtual time pass.

        Raises:
            UsageError: It is less than 0, or not finite.
        """
        check_number("wait", seconds, WAIT)
        self.clock.wait_until(self.clock.now() + seconds)

    def record(self, path: str | Path) -> None:
        """Write every byte from now on into a trace, until `close`."""
        self._taps.append(Recorder(self.world, Path(path)))

    def check(self, path: str | Path) -> None:
        """Compare every byte from now on with a trace; a difference is an AssertionError."""
        self._taps.append(Checker(self.world, Path(path)))

    def golden(self, path: str | Path) -> None:
        """Check against a trace if it is there; if not, record it for the next time.

        A test that fails leaves no recording.
        """
        if Path(path).exists():
            self.check(path)
        else:
            self.record(path)
            self._recorded.append(Path(path))

    def drop_golden(self) -> None:
        """Close, and remove what `golden` has recorded: the test has failed."""
        try:
            self.close()
        finally:
            self._remove_recorded()

    def _remove_recorded(self) -> None:
        for path in self._recorded:
            path.unlink(missing_ok=True)

    def close(self) -> None:
        """Disconnect robots, close ports of SDKs, end traces, and forget the world.

        All of it is done whatever fails; the first error is raised, and later ones are its notes.

        Raises:
            TraceError: Not all that a trace holds has happened.
        """
        self._ending().close()

    def _ending(self) -> ExitStack:
        """Return what there is to close, the last first; a second time there is nothing left."""
        stack = ExitStack()
        stack.push(_closing(partial(check_played, self.world)))
        stack.callback(unregister_world, self._name)
        close = [robot.stack.close for robot in self._robots]
        close += [port.closePort for port in self._sdk_ports]
        close += [tap.close for tap in self._taps]
        for each in reversed(close):
            stack.push(_closing(each))
        self._robots, self._sdk_ports, self._taps = [], [], []
        return stack

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        with ExitStack() as stack:
            if error is not None:
                stack.callback(self._remove_recorded)
            self._ending().__exit__(kind, error, trace)

    def _url(self, bus: str) -> str:
        return f"{self.url}&bus={bus}" if bus else self.url


def _closing(close: Callable[[], object]) -> Callable[..., None]:
    """Return a function for an `ExitStack` that closes, and hides no error that came before."""

    def leave(
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            close()
        except Exception as second:
            if error is None:
                raise
            error.add_note(f"closing has failed too: {second}")

    return leave
