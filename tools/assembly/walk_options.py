"""What a user asks of a walk."""

from dataclasses import dataclass
from pathlib import Path

from windup.control.limit_cycle.step_memory import Reuse
from windup.control.pose_graph.gait_file import Sampling
from windup.control.steering.guide import Guide
from windup.tools.terminal.quantities import Metres, Speed, TurnRate


@dataclass(frozen=True)
class WalkOptions:
    """How to walk. What is None is as the gait says."""

    gait: str = "walk"
    speed: Speed | None = None
    side: Speed = 0.0
    turn: TurnRate = 0.0
    style: tuple[str, ...] = ()
    blend: tuple[str, ...] = ()
    path: str | None = None
    to: tuple[Metres, Metres] | None = None
    guide: Guide | None = None  # instead of all these
    rv: tuple[str, ...] | None = None
    sampling: Sampling | None = None
    target: tuple[str, ...] = ()
    model: Reuse = "full"
    learn: Path | None = None  # file that keeps the step models
    torso_servo: bool = True
    open_loop: bool = False
    catch: str | None = None  # by which rule steps catch what the walk cannot absorb
