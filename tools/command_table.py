"""Every subcommand: where it is, and what it does in a few words. None is imported here."""

from importlib import import_module
from typing import Any, Final, NamedTuple


class Entry(NamedTuple):
    """A subcommand.

    Attributes:
        module: The module that has it.
        kind: Name of its class there, a `windup.tools.command.Command`.
        gist: What it does.
    """

    module: str
    kind: str
    gist: str

    def load(self) -> Any:
        """Import and return its class."""
        return getattr(import_module(self.module), self.kind)


COMMANDS: Final[dict[str, Entry]] = {
    "walk": Entry("windup.tools.walk", "Walk", "Walk in balance and say how it went"),
    "play": Entry("windup.tools.play", "Play", "Play a pose graph to its end, or for some seconds"),
    "stand": Entry("windup.tools.stand", "Stand", "Stand in the stance for some seconds"),
    "rise": Entry("windup.tools.rise", "Rise", "Get up from where it lies"),
    "push": Entry(
        "windup.tools.push", "Push", "Push a twin that stands or walks; does it stay up?"
    ),
    "step": Entry("windup.tools.step", "Step", "Put one foot where it is told"),
    "footprints": Entry(
        "windup.tools.footprints", "Footprints", "Walk footprints from a file, or random ones"
    ),
    "stride": Entry(
        "windup.tools.stride",
        "Stride",
        "Walk as an inverted pendulum, in any direction, and halt",
    ),
    "stop": Entry("windup.tools.stop", "Stop", "Switch all torque off, and read it back"),
    "scan": Entry("windup.tools.scan", "Scan", "Look for servos on a port, at every baud rate"),
    "emulate": Entry(
        "windup.tools.emulate",
        "Emulate",
        "Serve the servos of a robot's twin to any program, until Ctrl-C",
    ),
    "health": Entry("windup.tools.health", "Health", "Say whether a running robot is well"),
    "robots": Entry("windup.tools.robots_list", "Robots", "List the robots and what they can do"),
    "estimate": Entry(
        "windup.tools.estimate", "Estimate", "Measure the estimated state against the twin's truth"
    ),
    "bench": Entry("windup.tools.bench", "Bench", "Measure speed, timing and safety"),
    "sweep": Entry(
        "windup.tools.sweep",
        "Sweep",
        "Run a command at many values of its options; one row for each run",
    ),
    "reproduce": Entry(
        "windup.tools.reproduce.command", "Reproduce", "Reproduce the figures of a paper"
    ),
    "synthesise": Entry(
        "windup.tools.synthesis.command", "Synthesise", "Improve a gait, or find one, with CMA-ES"
    ),
}
