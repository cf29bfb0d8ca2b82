"""Servo buses for tests: a robot's emulated bus, its faults, traces, and the real driver on it.

with ServoBus("op3", seed=1) as bus:
    bus.faults.drop(ids=[7], rate=0.02)
    robot = bus.robot()
    robot.stand()
"""

import math
from itertools import count
from pathlib import Path
from types import TracebackType
from typing import Any, Self
from urllib.parse import urlencode

import serial

from windup.hal.backend import Clock
from windup.hal.errors import UsageError
from windup.hal.port.open_port import open_port
from windup.hal.port.port import Port
from windup.sim_twin.wire import build_world, drop_world, parse_address, put_world
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.faults.faults import Faults
from windup.sim_twin.wire.serve.tape import check_played, tape_world
from windup.sim_twin.wire.serve.trace import Checker, Recorder, Tap
from windup.sim_twin.wire.world.bus_world import BusWorld, VirtualClock
from windup.sim_twin.wire.world.hand import Swing
from windup.tools.robot.robot import Robot

_numbers = count(1)


class ServoBus:
    """The emulated buses of one robot, on a virtual clock.

    Args:
        robot: Name of a robot, path of a folder with one, or "bench" with `servos`.
        physics: "mujoco": the robot's twin; "inertia": each servo alone with its inertia.
        seed: Seed of the faults.
        faults: Faults as a URL has them; or add them to `faults`.
        **options: What else a twin:// URL says, such as servos, missing, latency, return_delay.

    Attributes:
        world: The world.
        clock: Its clock; it moves when somebody waits.
        faults: What goes wrong.
        url: What to open: any pyserial program in this process can.
    """

    def __init__(
        self,
        robot: str,
        *,
        physics: str = "mujoco",
        seed: int = 0,
        faults: str = "",
        **options: str | float,
    ) -> None:
        self._robot, self._seed = str(robot), seed
        given = {"physics": physics, "seed": seed, "faults": faults, **options}
        query = urlencode({key: value for key, value in given.items() if value != ""}, safe=":,;")
        if set(given) & {"clock", "world"}:
            raise UsageError("a servo bus chooses its own clock and world")
        world = build_world(parse_address(f"twin://{robot}?{query}"))
        self._begin(world)

    @classmethod
    def replay(cls, path: str | Path) -> Self:
        """Return buses that answer from a trace; a host that sends other bytes is told so."""
        bus = cls.__new__(cls)
        bus._robot, bus._seed = "", 0
        bus._begin(tape_world(Path(path)))
        return bus

    def _begin(self, world: BusWorld) -> None:
        self.world = world
        self._name = f"servo-bus-{next(_numbers)}"
        put_world(self._name, world)
        self.clock: Clock = VirtualClock(world)
        self.faults: Faults = world.faults
        self.url = f"twin://{self._robot or 'tape'}?clock=virtual&world={self._name}"
        self._robots: list[Robot] = []
        self._taps: list[Tap] = []

    def robot(self, **options: Any) -> Robot:
        """Return the robot, opened with the real driver on these buses; see `Robot.open`."""
        if not self._robot:
            raise UsageError("a trace says nothing of a robot; open `url` with a driver")
        robot = Robot.open(self._robot, port=self.url, **{"seed": self._seed, **options})
        self._robots.append(robot)
        return robot

    def port(self, bus: str = "", baud: int = 1_000_000) -> Port:
        """Return an open port of the driver on a bus, the first by default."""
        return open_port(self._url(bus), baud)

    def serial(self, bus: str = "", baud: int = 1_000_000, timeout: float = 0.02) -> Any:
        """Return an open pyserial port on a bus, the first by default."""
        return serial.serial_for_url(self._url(bus), baudrate=baud, timeout=timeout)

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
        self.world.hand(Swing(joint, math.radians(degrees), seconds))

    def wait(self, seconds: float) -> None:
        """Let time pass."""
        self.clock.wait_until(self.clock.now() + seconds)

    def record(self, path: str | Path) -> None:
        """Write every byte from now on into a trace, until `close`."""
        self._taps.append(Recorder(self.world, Path(path)))

    def check(self, path: str | Path) -> None:
        """Compare every byte from now on with a trace; a difference is an AssertionError."""
        self._taps.append(Checker(self.world, Path(path)))

    def golden(self, path: str | Path) -> None:
        """Check against a trace if it is there; if not, record it for the next time."""
        if Path(path).exists():
            self.check(path)
        else:
            self.record(path)

    def close(self) -> None:
        """Disconnect robots, end traces, and forget the world.

        Raises:
            TraceError: Not all that a trace holds has happened.
        """
        try:
            for robot in self._robots:
                robot.stack.close()
            for tap in self._taps:
                tap.close()
        finally:
            self._robots, self._taps = [], []
            drop_world(self._name)
        check_played(self.world)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is None:
            self.close()
        else:
            drop_world(self._name)

    def _url(self, bus: str) -> str:
        return f"{self.url}&bus={bus}" if bus else self.url
