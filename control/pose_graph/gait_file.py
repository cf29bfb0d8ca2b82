"""Gait files: pose graphs, perturbations and their balance as TOML that people write.

Angles are in degrees and times in seconds, as the literature prints them. The records below are
the format; `windup.control.pose_graph.gait` turns them into arrays.
"""

from typing import Annotated, Literal

from msgspec import Meta

from windup.hal.config import Count, NotNegative, Part, Positive, Record, Seconds

Axis = Literal["forward", "lateral"]
Sampling = Literal["sp", "fl", "lf", "full"]
Pose = dict[str, float] | list[float]


class Until(Record, frozen=True):
    """What ends a state: a hold time, or a contact with an optional time-out."""

    time: Seconds | None = None
    contact: str | None = None
    timeout: Seconds | None = None


class Reach(Record, frozen=True):
    """What must be true before a played graph goes on; all of it, at one instant.

    `joints` is how far any joint may be from its goal, degrees; `still` how fast any may move,
    degrees/s; `lean` the least and the most forward lean of the base and `side` its lean to either
    side, degrees; `feet` asks for every foot on the ground. What is not true `within` s of the
    state's own time is tried again from the state `again` (this one by default).
    """

    joints: Positive | None = None
    still: Positive | None = None
    lean: tuple[float, float] | None = None
    side: Positive | None = None
    feet: bool = False
    within: Seconds = 1.0
    again: str | None = None


class State(Record, frozen=True):
    """One row of a pose table; angles in degrees, added to the file's `pose`.

    `move` is for graphs that are played, as `reach` is: the goals take so long to the pose, s.
    """

    name: str
    until: Until
    move: Seconds = 0.0
    reach: Reach | None = None
    pose: Pose = {}
    next: str | None = None
    stance: str | None = None
    ends_step: bool = False


class Perturbation(Record, frozen=True):
    """A linear parametric perturbation, for one degree (or one second) of scaling.

    `pose` is added to the states of the steps that stand on `stance`; the steps on the other
    foot get the mirror image, or with `opposite` its negative, which is how one turns. `states`
    narrows it down; entries of one name add up. `hold` changes hold times, in seconds.
    """

    name: str
    axis: Axis = "forward"
    stance: str | None = None
    states: list[str] | None = None
    pose: dict[str, float] = {}
    opposite: bool = False
    hold: float = 0.0
    sample: Positive = 1.0
    limit: NotNegative = 20.0


class Balance(Record, frozen=True):
    """How the gait keeps its balance.

    A step is planned again in its middle when the centre of mass is `replan` m/s faster or slower
    than it was at the same state two steps ago. Scalings found from farther away than `miss`
    (weighted) are improved by up to `rounds` more models. The rollouts' ground is a plane through
    what the feet have touched in the last `footfalls` steps; with 0 it is level.
    """

    regulation: list[str] = []
    perturbations: list[str] = []
    targets: dict[str, float] = {}
    sampling: Sampling = "full"
    centred: bool = False
    from_last: bool = True
    keep: NotNegative = 0.7
    regularisation: NotNegative = 1e-3
    weights: dict[str, NotNegative] = {}
    drift: NotNegative = 0.5
    replan: Positive | None = None
    footfalls: Count = 0
    rounds: Count = 0
    miss: NotNegative = 0.3
    horizon: Annotated[float, Meta(gt=0.0, le=60.0)] = 1.5


class SpeedRow(Record, frozen=True):
    """What a commanded speed means: scalings of perturbations and targets, before feedback."""

    speed: float
    scale: dict[str, float] = {}
    targets: dict[str, float] = {}


class Speed(Record, frozen=True):
    """Commanded speed: rows that are interpolated, and feedback of the measured speed.

    A walk begins at the speed `begin` and gains `ramp` m/s a step. Without a `default` the table
    only counts when a speed is commanded. `correct` names the target or the perturbation that the
    feedback moves, by `gain` times the error, m/s, each step; `also` names targets that move with
    it, by so much for each unit (a slower robot leans forward, Eq. 5.1).
    """

    rows: list[SpeedRow]
    default: float | None = None
    begin: float = 0.0
    ramp: Positive = 1.0
    correct: str | None = None
    also: dict[str, float] = {}
    gain: float = 0.0
    limit: NotNegative = 0.0


class Side(Record, frozen=True):
    """Commanded sideways speed: scalings and targets for 1 m/s to the left, before feedback.

    `scale` follows the sign of the speed, `spread` does not (to keep the legs apart). `targets`
    are lateral: they are added in steps that swing the foot on the side that one goes to, and
    subtracted in the others. `limit` is the largest speed, m/s; it grows by `ramp` a step.
    """

    limit: NotNegative
    ramp: Positive = 1.0
    scale: dict[str, float] = {}
    spread: dict[str, float] = {}
    targets: dict[str, float] = {}
    gain: float = 0.0
    correction: float = 0.0


class Turn(Record, frozen=True):
    """Commanded turning; `limit` is the fastest, degrees/s.

    `feed` is the scaling for each degree that one step shall turn, `spread` scalings for one
    degree/s either way. The rate changes by `ramp` degrees/s a step. `perturbation` turns where
    that of the heading is only good for holding a course. On a path, tight turns are walked at
    `speed` m/s, and none tighter than `radius` m.
    """

    limit: NotNegative
    ramp: Positive = 1000.0
    feed: float = 0.0
    spread: dict[str, float] = {}
    perturbation: str | None = None
    speed: NotNegative = 0.0
    radius: NotNegative = 0.0


class Heading(Record, frozen=True):
    """Holding a course: a perturbation scaled by the error of the heading, degrees a degree."""

    perturbation: str
    gain: float
    limit: NotNegative = 10.0


class Incline(Record, frozen=True):
    """Tilting the soles with the ground: a perturbation scaled by how far a variable misses.

    The scaling tends to `gain` times the miss of `variable`, by the share `rate` a step.
    """

    perturbation: str
    gain: float
    limit: NotNegative
    variable: str = "up.forward"
    rate: Part = 0.1


class Slip(Record, frozen=True):
    """Walking with care on slippery ground.

    From when the stance foot has slid more than `least` m in one of the `states`, in two steps
    running, the walk takes on a style.
    """

    states: list[str]
    style: str
    least: NotNegative


class Style(Record, frozen=True):
    """A way of walking that can be had by any amount: scalings and targets for an amount of one.

    Styles compose by addition, and an amount between 0 and 1 blends (section 5.4). The amount
    changes by at most 1 / `steps` a step.
    """

    name: str
    scale: dict[str, float] = {}
    targets: dict[str, float] = {}
    steps: Positive = 8.0
    least: float = 0.0
    most: float = 1.0


class TorsoServo(Record, frozen=True):
    """A joint driven so that the torso keeps `angle` degrees of forward lean (section 3.8)."""

    joint: str
    angle: float = 0.0


class Upright(Record, frozen=True):
    """How a graph that is played keeps its balance, see `windup.control.motions.upright`.

    Gains by joint: `forward` and `right` in degrees for one degree of the base's lean, the rates in
    degrees for one degree/s. `limit` is the most that comes to a goal, degrees. `states` narrows
    it down.
    """

    forward: dict[str, float] = {}
    forward_rate: dict[str, float] = {}
    right: dict[str, float] = {}
    right_rate: dict[str, float] = {}
    limit: NotNegative = 25.0
    states: list[str] | None = None


class GaitFile(Record, frozen=True):
    """One file of `gaits/`: a pose graph and, for a walk, how it is balanced.

    `tries` is how often a state with a `reach` is tried before the graph is given up. A graph that
    gets the robot up says on which side it is `lying` before; one that ends on the floor is `down`.
    """

    title: str
    state: list[State]
    source: str = ""
    start: str | None = None
    columns: list[str] = []
    pose: dict[str, float] = {}
    mirror: bool = False
    loop: bool = True
    tries: Annotated[int, Meta(ge=1, le=1_000)] = 3
    lying: Literal["front", "back"] | None = None
    down: bool = False
    upright: Upright | None = None
    perturbation: list[Perturbation] = []
    balance: Balance | None = None
    speed: Speed | None = None
    side: Side | None = None
    turn: Turn | None = None
    heading: Heading | None = None
    incline: Incline | None = None
    slip: Slip | None = None
    style: list[Style] = []
    torso_servo: TorsoServo | None = None

    @property
    def attitude(self) -> bool:
        """True where the base's attitude decides: feedback balances, or a state asks for a lean."""
        reaches = (state.reach for state in self.state if state.reach is not None)
        leans = any(reach.lean is not None or reach.side is not None for reach in reaches)
        return self.upright is not None or leans

    @property
    def staged(self) -> bool:
        """True where a state moves to its pose or has to reach something, or feedback balances."""
        if self.upright is not None:
            return True
        return any(state.move > 0.0 or state.reach is not None for state in self.state)
