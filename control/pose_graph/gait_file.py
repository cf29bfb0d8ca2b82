"""Format of gait files: pose graphs, perturbations and balance, as TOML written by people.

Angles are in degrees and times in seconds, as in the literature. The records below define the
format; `windup.control.pose_graph.gait` converts them into arrays.
"""

from typing import Annotated, Literal

from msgspec import Meta

from windup.hal.config import Count, Fraction, NotNegative, Positive, Seconds, TomlRecord

Axis = Literal["forward", "lateral"]
Sampling = Literal["sp", "fl", "lf", "full"]
Pose = dict[str, float] | list[float]


class Until(TomlRecord, frozen=True):
    """End of a state: a hold time, s, or a contact with an optional time-out, s."""

    time: Seconds | None = None
    contact: str | None = None
    timeout: Seconds | None = None


class Reach(TomlRecord, frozen=True):
    """Condition for the end of a state in a graph that is played; all parts at the same instant.

    `joints` is the maximum error of any joint, degrees; `still` the maximum speed of any joint,
    degrees/s; `lean` the minimum and maximum forward lean of the base and `side` its maximum lean
    to either side, degrees; `feet` requires every foot on the ground. If the condition is not met
    `within` s after the hold time, the graph is retried from the state `again` (default: this one).
    """

    joints: Positive | None = None
    still: Positive | None = None
    lean: tuple[float, float] | None = None
    side: Positive | None = None
    feet: bool = False
    within: Seconds = 1.0
    again: str | None = None


class State(TomlRecord, frozen=True):
    """One row of a pose table; angles in degrees, added to the file's `pose`.

    `move` and `reach` are for graphs that are played; `move` is the time in which the goals move
    to the pose, s.
    """

    name: str
    until: Until
    move: Seconds = 0.0
    reach: Reach | None = None
    pose: Pose = {}
    next: str | None = None
    stance: str | None = None
    ends_step: bool = False


class Perturbation(TomlRecord, frozen=True):
    """A linear parametric perturbation: changes of poses and hold times for a scaling of 1.

    `pose`, degrees, is added to the states of the steps on stance foot `stance`; the steps on the
    other foot get its mirror image, or with `opposite` the negative of that, as for turning.
    `states` restricts it to some states; entries of one name add up. `hold` changes hold times, s.
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


class Balance(TomlRecord, frozen=True):
    """Parameters of the gait's balance control.

    A step is replanned when the CoM velocity at a state differs by more than `replan` m/s from
    that at the same state two steps ago. If the weighted error of the nominal rollout exceeds
    `miss`, the scalings are improved with up to `rounds` more models. The rollouts' ground is a
    plane fitted to the contact points of the last `footfalls` steps; with 0 it is level.
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


class SpeedRow(TomlRecord, frozen=True):
    """Scalings of perturbations and targets for one commanded speed, m/s, before feedback."""

    speed: float
    scale: dict[str, float] = {}
    targets: dict[str, float] = {}


class Speed(TomlRecord, frozen=True):
    """Commanded speed: rows that are interpolated, and feedback of the measured speed.

    A walk begins at the speed `begin` and changes by `ramp` m/s per step. Without a `default` the
    table only applies if a speed is commanded. `correct` names the target or perturbation that the
    feedback changes, by `gain` times the speed error, m/s, at each step; `also` gives changes of
    other targets per unit of that correction (a slower robot leans forward, Eq. 5.1).
    """

    rows: list[SpeedRow]
    default: float | None = None
    begin: float = 0.0
    ramp: Positive = 1.0
    correct: str | None = None
    also: dict[str, float] = {}
    gain: float = 0.0
    limit: NotNegative = 0.0


class Side(TomlRecord, frozen=True):
    """Commanded sideways speed: scalings and targets for 1 m/s to the left, before feedback.

    `scale` follows the sign of the speed, `spread` its magnitude (to keep the legs apart).
    `targets` are lateral: they are added in steps whose swing foot is on the side of the motion,
    and subtracted in the others. `limit` is the maximum speed, m/s; `ramp` its change per step.
    """

    limit: NotNegative
    ramp: Positive = 1.0
    scale: dict[str, float] = {}
    spread: dict[str, float] = {}
    targets: dict[str, float] = {}
    gain: float = 0.0
    correction: float = 0.0


class Turn(TomlRecord, frozen=True):
    """Commanded turning; `limit` is the maximum turn rate, degrees/s.

    `feed` is the scaling per degree of turn in a step, `spread` scalings per degree/s in either
    direction. The rate changes by at most `ramp` degrees/s per step. `perturbation` is used for
    turning if that of the heading is only suitable for holding a course. On a path, tight turns
    are walked at `speed` m/s, and `radius` m is the minimum turning radius.
    """

    limit: NotNegative
    ramp: Positive = 1000.0
    feed: float = 0.0
    spread: dict[str, float] = {}
    perturbation: str | None = None
    speed: NotNegative = 0.0
    radius: NotNegative = 0.0


class Heading(TomlRecord, frozen=True):
    """Course control: a perturbation scaled by `gain` times the heading error, degrees."""

    perturbation: str
    gain: float
    limit: NotNegative = 10.0


class Incline(TomlRecord, frozen=True):
    """Slope compensation: a perturbation scaled by the filtered error of a regulation variable.

    The scaling approaches `gain` times the error of `variable` by the share `rate` per step.
    """

    perturbation: str
    gain: float
    limit: NotNegative
    variable: str = "up.forward"
    rate: Fraction = 0.1


class Slip(TomlRecord, frozen=True):
    """Style for slippery ground.

    Once the stance foot has slid by more than `least` m during one of the `states` in two
    consecutive steps, the walk changes to `style`.
    """

    states: list[str]
    style: str
    least: NotNegative


class Style(TomlRecord, frozen=True):
    """A style of walking with a variable amount: scalings and targets for an amount of 1.

    Styles add up, and an amount between 0 and 1 blends (section 5.4). Amounts are in `least` ..
    `most`; the larger of these magnitudes is reached in `steps` steps.
    """

    name: str
    scale: dict[str, float] = {}
    targets: dict[str, float] = {}
    steps: Positive = 8.0
    least: float = 0.0
    most: float = 1.0


class TorsoServo(TomlRecord, frozen=True):
    """A joint that keeps the torso at a forward lean of `angle` degrees (section 3.8)."""

    joint: str
    angle: float = 0.0


class Upright(TomlRecord, frozen=True):
    """Balance feedback of a graph that is played, see `windup.control.motions.upright`.

    Gains by joint: `forward` and `right` in degrees per degree of the base's lean, the rates in
    degrees per degree/s. `limit` is the maximum change of a goal, degrees. `states` restricts the
    feedback to some states.
    """

    forward: dict[str, float] = {}
    forward_rate: dict[str, float] = {}
    right: dict[str, float] = {}
    right_rate: dict[str, float] = {}
    limit: NotNegative = 25.0
    states: list[str] | None = None


class GaitFile(TomlRecord, frozen=True):
    """One file of `gaits/`: a pose graph and, for a walk, its balance control.

    `tries` is the number of tries of a state with a `reach` before the graph is aborted. `lying`
    is the side on which the robot lies before a graph that gets it up; `down` is true if the robot
    is on the floor at the end.
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
        """True if the graph needs the base's attitude, for balance feedback or for a `reach`."""
        reaches = (state.reach for state in self.state if state.reach is not None)
        leans = any(reach.lean is not None or reach.side is not None for reach in reaches)
        return self.upright is not None or leans

    @property
    def staged(self) -> bool:
        """True if the file uses `move`, `reach` or `upright`."""
        if self.upright is not None:
            return True
        return any(state.move > 0.0 or state.reach is not None for state in self.state)
