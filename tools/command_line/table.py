"""Table of all subcommands, with module and summary; their modules are imported on use only."""

from importlib import import_module
from typing import Any, Final, NamedTuple


class Entry(NamedTuple):
    """A subcommand.

    Attributes:
        module: Its module, relative to `windup.tools`.
        kind: Name of its class, a `windup.tools.terminal.command.Command`.
        gist: Summary of what it does.
    """

    module: str
    kind: str
    gist: str

    def load(self) -> Any:
        """Import and return the class."""
        return getattr(import_module(f"windup.tools.{self.module}"), self.kind)


COMMANDS: Final[dict[str, Entry]] = {
    "walk": Entry("commands.walk", "Walk", "Walk in balance and say how it went"),
    "play": Entry("commands.play", "Play", "Play a pose graph to its end, or for some seconds"),
    "stand": Entry("commands.stand", "Stand", "Stand in the stance for some seconds"),
    "rise": Entry("commands.rise", "Rise", "Get up from where it lies"),
    "push": Entry("commands.push", "Push", "Push a twin that stands or walks; does it stay up?"),
    "step": Entry("commands.step", "Step", "Put one foot where it is told"),
    "footprints": Entry(
        "commands.footprints", "Footprints", "Walk footprints from a file, or random ones"
    ),
    "stride": Entry(
        "commands.stride",
        "Stride",
        "Walk as an inverted pendulum, in any direction, and halt",
    ),
    "up": Entry("runtime.commands.up", "Up", "Own a robot, and hold it between two behaviours"),
    "down": Entry(
        "runtime.commands.down", "Down", "Let a robot that is up rest, and end its runtime"
    ),
    "status": Entry("runtime.commands.status", "Status", "Show what robots that are up do"),
    "stop": Entry(
        "commands.stop", "Stop", "Stop a robot from any terminal, and read its torque back"
    ),
    "run": Entry("commands.run", "Run", "Run a controller of your own, from a file of Python"),
    "scan": Entry("bringup.scan", "Scan", "Look for servos on a port, at every baud rate"),
    "emulate": Entry(
        "commands.emulate",
        "Emulate",
        "Serve the servos of a robot's twin to any program, until Ctrl-C",
    ),
    "health": Entry("bringup.health", "Health", "Say whether a running robot is well"),
    "robots": Entry("commands.robots_list", "Robots", "List the robots and what they can do"),
    "check": Entry("commands.check", "Check", "Show all errors and warnings of a robot folder"),
    "new": Entry("commands.new", "New", "Write an example robot, gait or controller"),
    "estimate": Entry(
        "commands.estimate", "Estimate", "Measure the estimated state against the twin's truth"
    ),
    "bench": Entry("benches.bench", "Bench", "Measure speed, timing and safety"),
    "sweep": Entry(
        "sweeps.sweep",
        "Sweep",
        "Run a command at many values of its options; one row for each run",
    ),
    "reproduce": Entry("reproduce.command", "Reproduce", "Reproduce the figures of a paper"),
    "synthesise": Entry(
        "synthesis.command", "Synthesise", "Improve a gait, or find one, with CMA-ES"
    ),
}
