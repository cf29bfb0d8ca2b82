"""Options that every command takes, and what they mean together."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro

from windup.hal.errors import UsageError
from windup.robots import load_robot
from windup.robots.inspection.doubt_once import doubt_once
from windup.sim_twin.wire.world.address import SCHEME
from windup.tools.options.faults import with_faults
from windup.tools.robot.port_urls import check_port
from windup.tools.robot.robot import Robot
from windup.tools.robot.stack import State
from windup.tools.terminal.command import Command
from windup.tools.terminal.quantities import Noise, Rate, Seed, Seeds


@dataclass(frozen=True, kw_only=True)
class Common(Command):
    """Options of every command that runs a robot."""

    robot: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="ROBOT")]
    """A robot's name (`windup robots` lists them), or the path of a folder with your own."""
    port: str | None = None
    """Servo bus: /dev/ttyUSB0, usb:SERIAL, socket://HOST:PORT, twin://ROBOT; or BUS=URL,BUS=URL."""
    faults: str = ""
    """What goes wrong on a twin:// port: drop:0.01,unplug:at=5:seconds=1,...; a wrong word gets the
    list."""
    arm: bool = False
    """Allow torque on a port that is not twin://. Hold on to the robot."""
    state: State | None = None
    """Where the base state comes from: the twin's truth (the default without a port), or an
    estimate from the sensors (the default on a port)."""
    rate: Rate | None = None
    """Rate of the control loop, Hz; the robot's own by default."""
    realtime: bool = False
    """Let simulated time pass no faster than real time."""
    seed: Seed = 0
    """Seed of everything random."""
    seeds: Seeds | None = None
    """Run seeds 0 .. N-1, one row each, with a summary."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""
    noise: Noise = 0.0
    """Standard deviation of noise on the start pose, degrees."""
    protect: bool = True
    """Soften a fall that cannot be prevented, where robot.toml says how."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        url, robot = self.url, load_robot(self.robot)
        if url is not None:
            check_port(robot, url)
            if self.noise and not url.startswith(f"{SCHEME}://"):
                raise UsageError("--noise is of a twin's start pose; leave it or --port away")
        elif self.arm and not self.remote:
            raise UsageError("--arm needs a --port; without one only the twin moves")

    def warn(self) -> None:
        """Say that something about the robot is doubtful; see `Command.warn`."""
        doubt_once(load_robot(self.robot))

    @property
    def remote(self) -> bool:
        """Does a runtime have the robot?"""
        return False

    @property
    def url(self) -> str | None:
        """The port, with its faults."""
        return with_faults(self.port, self.faults)

    @property
    def all_seeds(self) -> list[int]:
        """The seeds to run."""
        return [self.seed] if self.seeds is None else list(range(self.seeds))

    def open_robot(self, seed: int, **more: Any) -> Robot:
        """Return the robot as these options say; see `Robot.open`, also for `more` of its options.

        Raises:
            WindupError: The robot's files, the options, or the bus cannot be.
        """
        return Robot.open(
            self.robot,
            port=self.url,
            arm=self.arm,
            state=self.state,
            rate=self.rate,
            realtime=self.realtime,
            seed=seed,
            noise=self.noise,
            protect=self.protect,
            **more,
        )
