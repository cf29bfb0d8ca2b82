"""One trial of a search: walks a gait from several noisy starts."""

from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from windup.control.pose_graph.gait_file import GaitFile
from windup.hal.errors import WindupError
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.robot.robot import Robot
from windup.tools.synthesis.gait_toml import write_gait

KEPT = (
    "steps",
    "steps_requested",
    "reason",
    "distance_m",
    "lateral_m",
    "heading_deg",
    "speed_m_s",
    "foot_clearance_mm",
    "flights",
    "skips",
    "flight_time_s",
    "sim_time_s",
    "cost_of_transport",
    "shake_rad_s",
)


@dataclass(frozen=True)
class Trial:
    """A gait to walk.

    Attributes:
        number: Number of the trial.
        robot: Name or folder of the robot.
        file: The gait.
        steps: Number of steps to walk.
        noise: Standard deviation of the noise on the start pose, degrees.
        seeds: Seeds of the walks, one walk each.
        speed: Commanded speed, m/s, or None for the gait's own.
    """

    number: int
    robot: str
    file: GaitFile
    steps: int
    noise: float
    seeds: tuple[int, ...]
    speed: float | None = None


def walk_trial(trial: Trial) -> list[dict[str, Any]]:
    """Walk a trial and return one row per seed.

    A gait that cannot be walked, or whose twin diverges, counts as having walked no step.
    """
    with TemporaryDirectory(prefix="windup-") as folder:
        path = Path(folder) / "trial.toml"
        write_gait(path, trial.file)
        return [_walk(trial, str(path), seed) for seed in trial.seeds]


def _walk(trial: Trial, gait: str, seed: int) -> dict[str, Any]:
    options = WalkOptions(gait=gait, speed=trial.speed)
    try:
        with Robot.open(trial.robot, seed=seed, noise=trial.noise) as robot:
            row = robot.walk(steps=trial.steps, options=options).result()
    except WindupError:
        return _nothing(trial.steps)
    return {name: row[name] for name in KEPT}


def _nothing(steps: int) -> dict[str, Any]:
    """Return the row of a walk that could not begin."""
    row: dict[str, Any] = dict.fromkeys(KEPT, 0.0)
    return row | {
        "steps": 0,
        "steps_requested": steps,
        "reason": "error",
        "speed_m_s": None,
        "cost_of_transport": None,
        "foot_clearance_mm": None,
    }
