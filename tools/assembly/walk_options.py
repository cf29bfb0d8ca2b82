"""What a user asks of a walk: the options of `windup walk`, and of `Robot.walk`."""

from dataclasses import dataclass
from pathlib import Path

from windup.control.limit_cycle.step_memory import Reuse
from windup.control.pose_graph.gait_file import Sampling
from windup.tools.terminal.quantities import Metres, Speed, TurnRate


@dataclass(frozen=True, kw_only=True)
class WalkOptions:
    """How to walk. What is None is as the gait says.

    Each field is an option of the command line, too, with its docstring as the help.
    """

    speed: Speed | None = None
    """Speed, m/s; the gait's default otherwise."""
    side: Speed = 0.0
    """Sideways speed, m/s; positive to the left."""
    turn: TurnRate = 0.0
    """Turn rate, degrees/s; positive to the left."""
    path: str | None = None
    """Follow a path: a CSV file of x,y waypoints, circle:RADIUS or square:SIDE, m."""
    to: tuple[Metres, Metres] | None = None
    """Walk to the point X Y, m, and stop."""
    style: tuple[str, ...] = ()
    """Styles and how much of them, NAME=AMOUNT; any perturbation of the gait is one too. With
    NAME=AMOUNT@BEGIN:END it comes and goes, s."""
    blend: tuple[str, ...] = ()
    """Gaits to blend into this one and how far, GAIT=AMOUNT, also with @BEGIN:END; at 1 the poses,
    times and targets are all theirs."""
    gait: str = "walk"
    """Name of the gait, or the path of a gait file of your own."""
    rv: tuple[str, ...] | None = None
    """Regulation variables, such as: up, or up.forward swing_com.lateral."""
    sampling: Sampling | None = None
    """How the step model is sampled."""
    model: Reuse = "full"
    """Sample the step model every step, or only when regulation drifts (frozen), or look it up by
    the start of the step (library): one rollout then does. See --learn."""
    learn: Path | None = None
    """Add the step models of this walk to a file: GAIT.models.json beside the gait is the library
    of `--model library`, and every step then takes one rollout."""
    target: tuple[str, ...] = ()
    """Targets of the regulation variables: VALUE for the first forward one, or NAME=VALUE."""
    torso_servo: bool = True
    """Keep the torso upright by its own servo, where the gait has one."""
    catch: bool = False
    """Let the stepper catch pushes that the walk cannot absorb: it steps, halts, and walks on."""
    way: str | None = None
    """How it steps then: the name of a step rule; that of its stepping by default."""
    open_loop: bool = False
    """Play the bare pose graph, without balance."""
