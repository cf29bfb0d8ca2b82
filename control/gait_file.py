"""Gait files: pose graphs, perturbations and their balance as TOML that people write.

Angles are in degrees and times in seconds, as the literature prints them. The records below are
the format; `control.gait` turns them into arrays.
"""

from typing import Literal

from hal.config import Record

Axis = Literal["forward", "lateral"]
Sampling = Literal["sp", "fl", "lf", "full"]
Pose = dict[str, float] | list[float]


class Until(Record, frozen=True):
    """What ends a state: a hold time, or a contact with an optional time-out."""

    time: float | None = None
    contact: str | None = None
    timeout: float | None = None


class State(Record, frozen=True):
    """One row of a pose table; angles in degrees, added to the file's `pose`."""

    name: str
    until: Until
    pose: Pose = {}
    next: str | None = None
    stance: str | None = None
    ends_step: bool = False


class Perturbation(Record, frozen=True):
    """A linear parametric perturbation, for one degree (or one second) of scaling.

    `pose` is added to the states of the steps that stand on `stance`; the steps on the other
    foot get the mirror image, or with `opposite` its negative, which is how one turns. `states`
    narrows it down. `hold` changes hold times, in seconds.
    """

    name: str
    axis: Axis = "forward"
    stance: str | None = None
    states: list[str] | None = None
    pose: dict[str, float] = {}
    opposite: bool = False
    hold: float = 0.0
    sample: float = 1.0
    limit: float = 20.0


class Balance(Record, frozen=True):
    """How the gait keeps its balance; every entry can be overridden at the command line."""

    regulation: list[str] = []
    perturbations: list[str] = []
    targets: dict[str, float] = {}
    sampling: Sampling = "full"
    centred: bool = False
    from_last: bool = True
    keep: float = 0.7
    regularisation: float = 1e-3
    weights: dict[str, float] = {}
    horizon: float = 1.5


class SpeedRow(Record, frozen=True):
    """What a commanded speed means: scalings of perturbations and targets, before feedback."""

    speed: float
    scale: dict[str, float] = {}
    targets: dict[str, float] = {}


class Speed(Record, frozen=True):
    """Commanded speed: rows that are interpolated, and feedback of the measured speed.

    A walk begins at the first row and gains `ramp` m/s a step.
    """

    default: float
    rows: list[SpeedRow]
    ramp: float = 1.0
    correct: str | None = None
    gain: float = 0.0
    limit: float = 0.0


class Heading(Record, frozen=True):
    """Holding a course: a perturbation scaled by heading and turn rate, degrees a degree."""

    perturbation: str
    gain: float
    rate: float = 0.0
    limit: float = 10.0


class TorsoServo(Record, frozen=True):
    """A joint driven so that the torso keeps `angle` degrees of forward lean (section 3.8)."""

    joint: str
    angle: float = 0.0


class GaitFile(Record, frozen=True):
    """One file of `gaits/`: a pose graph and, for a walk, how it is balanced."""

    title: str
    state: list[State]
    source: str = ""
    start: str | None = None
    columns: list[str] = []
    pose: dict[str, float] = {}
    mirror: bool = False
    loop: bool = True
    perturbation: list[Perturbation] = []
    balance: Balance | None = None
    speed: Speed | None = None
    heading: Heading | None = None
    torso_servo: TorsoServo | None = None
