"""Options that every command takes, and what they mean together."""

from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import Annotated, Any

import tyro

from hal.errors import UsageError
from tools.faults import with_faults
from tools.robot import Robot
from tools.stack import State


@dataclass(frozen=True, kw_only=True)
class Common:
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
    rate: float | None = None
    """Rate of the control loop, Hz; the robot's own by default."""
    realtime: bool = False
    """Let simulated time pass no faster than real time."""
    seed: int = 0
    """Seed of everything random."""
    seeds: int | None = None
    """Run seeds 0 .. N-1, one row each, with a summary."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""
    plot: Path | None = None
    """Draw the run into an image file."""

    noise: float = 0.0
    """Standard deviation of noise on the start pose, degrees."""
    protect: bool = True
    """Soften a fall that cannot be prevented, where robot.toml says how."""

    def check(self) -> None:
        """Raise what cannot be, before anything is opened.

        Raises:
            UsageError: An option is out of its range.
        """
        with_faults(self.port, self.faults)
        if self.seeds is not None and self.seeds < 1:
            raise UsageError(f"--seeds {self.seeds}: give 1 or more")
        if self.seed < 0:
            raise UsageError(f"--seed {self.seed}: give 0 or more")
        if self.rate is not None and not 0.0 < self.rate < inf:
            raise UsageError(f"--rate {self.rate:g}: give a rate above 0 Hz")
        if not 0.0 <= self.noise < inf:
            raise UsageError(f"--noise {self.noise:g}: give 0 degrees or more")

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
