"""A robot that is up, as a program has it: `Robot.connect`."""

from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Any, Self

from windup.hal.joints import Array
from windup.tools.remote.client import RuntimeClient
from windup.tools.remote.messages import Ended, Goal, Release, Status
from windup.tools.stopping.stop_runs import Stopped, robot_name, stop_runs


class RemoteReport:
    """How a behaviour went on a robot that is up.

    Attributes:
        good: The robot did what was asked.
        reason: Why it ended.
        result: The numbers, as in the JSON of the command.
    """

    def __init__(self, ended: Ended) -> None:
        self.good, self.reason, self.result = ended.good, ended.reason, ended.result
        self._lines = ended.lines

    def __str__(self) -> str:
        return "\n".join(self._lines)


class Stream:
    """Goals that are streamed to a robot that is up; see `RemoteRobot.stream`."""

    def __init__(self, client: RuntimeClient) -> None:
        self._client = client

    def write(self, position: Array) -> None:
        """Give the goal of all joints, (n,) rad; the robot holds when none follows soon.

        Raises:
            HardwareError: The runtime has ended.
        """
        self._client.send(Goal(position=tuple(map(float, position))))


class RemoteRobot:
    """A robot that is up, whose runtime does what this program wants.

    Leaving it ends what it does, and leaves it held.

    Args:
        name: Name of the robot, or path of its folder.
        program: What this program is called in messages.

    Attributes:
        name: Name of the robot.
        port: URL of its port; None for a twin.
        joints: Names of its joints.

    Raises:
        UsageError: The robot is not up, or its runtime has another version.
    """

    def __init__(self, name: str, program: str = "a program") -> None:
        self._client = RuntimeClient(robot_name(name), program)
        welcome = self._client.welcome
        self.name, self.port, self.joints = welcome.robot, welcome.port, welcome.joints

    @property
    def status(self) -> Status:
        """How it is now: state, torque, who has it, counts of goals."""
        return self._client.status()

    def stand(self, seconds: float = 2.0) -> RemoteReport:
        """Hold the stance for `seconds` s."""
        return self.run("stand", seconds=seconds)

    def play(self, graph: str, seconds: float | None = None) -> RemoteReport:
        """Play a pose graph to its end, or for `seconds` s."""
        return self.run("play", graph=graph, seconds=seconds)

    def walk(self, speed: float | None = None, steps: int = 40, **options: Any) -> RemoteReport:
        """Walk a number of steps, come to rest, and stand; `options` are those of the command."""
        return self.run("walk", speed=speed, steps=steps, **options)

    def run(self, behaviour: str, *, arm: bool = False, **options: Any) -> RemoteReport:
        """Run a behaviour to its end.

        Args:
            behaviour: Name of the behaviour, as on the command line.
            arm: Switch torque on again after a stop.
            **options: Its options.

        Raises:
            UsageError: It cannot be, or another client has the robot; nothing has moved.
            HardwareError: The runtime has ended.
        """
        return self.wait(self.begin(behaviour, arm=arm, **options))

    def begin(self, behaviour: str, *, arm: bool = False, **options: Any) -> int:
        """Begin a behaviour, in place of the present one; return its number, for `wait`.

        Raises:
            UsageError: As of `run`.
        """
        return self._client.run(behaviour, options, arm=arm)

    def wait(self, number: int) -> RemoteReport:
        """Wait until a behaviour has ended; return how it went."""
        return RemoteReport(self._client.wait(number))

    def change(
        self,
        *,
        speed: float | None = None,
        side: float | None = None,
        turn: float | None = None,
        style: dict[str, float] | None = None,
    ) -> None:
        """Change the walk that goes on, from its next step on.

        Args:
            speed: Forward speed, m/s; None leaves it as it is.
            side: Sideways speed, m/s; positive to the left.
            turn: Turn rate, rad/s; positive to the left.
            style: Amounts of styles by name.
        """
        self._client.change(speed=speed, side=side, turn=turn, style=style)

    def end(self) -> None:
        """End the behaviour; the robot comes to rest, if it can, and is held."""
        self._client.end()

    def stop(self) -> list[Stopped]:
        """Stop the robot by its stop policy, as `windup stop` does; return what was read back."""
        return stop_runs(self.name)

    @contextmanager
    def stream(self) -> Iterator[Stream]:
        """Stream goals to the robot, while it holds.

        Raises:
            UsageError: Another client has the robot.
        """
        self._client.take()
        try:
            yield Stream(self._client)
        finally:
            self._client.send(Release())

    def close(self) -> None:
        """Leave the robot; it is held."""
        self._client.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
