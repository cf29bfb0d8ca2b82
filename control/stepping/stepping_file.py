"""Format of a robot's `stepping.toml`: parameters of steps against pushes. SI units."""

from typing import Annotated, Literal

from msgspec import Meta

from windup.control.stepping.step_decision import Damping, Reach, StepRule, find_rule
from windup.hal.config import Fraction, Positive, Seconds, TomlRecord
from windup.hal.joints import Array

Metres = Annotated[float, Meta(ge=0.0, le=100.0)]
Support = Literal["hull", "capsule"]


class ReachTable(TomlRecord, frozen=True):
    """Bounds of a foot's place relative to the other foot, m.

    See `windup.control.stepping.step_decision.Reach`.
    """

    back: Annotated[float, Meta(le=0.0)]
    front: Metres
    near: Metres
    far: Metres

    def reach(self) -> Reach:
        """Return the same as a `Reach`."""
        return Reach(self.back, self.front, self.near, self.far)


class RuleTable(TomlRecord, frozen=True):
    """Dampings of a rule, in omega; without `where` the predicted capture point is the target."""

    when: Damping
    where: Damping | None = None


class ComfortTable(TomlRecord, frozen=True, kw_only=True):
    """Comfort steps of a robot that stands still: times and tolerances.

    Attributes:
        shift: Time to shift the centre of mass over one foot, and time to shift it back, s.
        pace: Maximum acceleration of a shift, m/s2; long ones therefore take longer than `shift`.
        least: Fraction of the shift after which the other foot may be lifted.
        wait: Additional time after the shift before the step is given up, s.
        swing: Duration of the swing, s.
        inside: Minimum distance of CoM and capture point inside a sole for standing on that foot
            alone, m.
        askew: Maximum yaw between the feet of a relaxed stance, rad.
    """

    shift: Positive = 0.5
    pace: Positive = 100.0
    least: Fraction = 0.0
    wait: Seconds = 0.3
    swing: Positive = 0.4
    inside: float = 0.02
    askew: Positive = 0.15


class CatchTable(TomlRecord, frozen=True):
    """Pushes during a walk that are answered by steps, by the deviation of the capture point.

    Attributes:
        back: Minimum backward deviation, m.
        slant: Maximum ratio of the lateral to the backward deviation.
        calm: Deviation below which a walk is undisturbed, m.
        fresh: Maximum time from the last undisturbed tick to a takeover, s; later the walk does
            better.
        resume: Time to move to the first pose of the walk before it resumes, s.
    """

    back: Positive
    slant: Positive
    calm: Positive = 0.02
    fresh: Seconds = 0.12
    resume: Seconds = 1.0

    def meets(self, thrown: Array) -> bool:
        """Return whether the deviation `thrown` (2,) m (ahead, left) is such a push."""
        ahead, left = thrown
        return bool(-ahead > self.back and abs(left) < -ahead * self.slant)


class Stepping(TomlRecord, frozen=True):
    """Stepping parameters; `up`, `lead`, `balance` and `trunk` are for position servos only.

    Attributes:
        stance: Name of the pose that the robot stands in, soles flat.
        reach: Bounds of a foot's place relative to the other foot.
        duration: Duration of a step, s.
        lift: Height to which the foot is lifted, m.
        up: Fraction of the step after which the foot is lowered.
        early: Fraction of the step from which contact counts as landing.
        late: Duration after which a step ends without contact, in multiples of `duration`.
        update: Fraction of the step until which the target is updated.
        dwell: Minimum time on both feet between two steps, s.
        settle: Time in which the base returns over the feet, s.
        lead: Time by which the goals are ahead, against the servos' lag, s.
        slack: Maximum distance of the trigger point outside the support, m; negative is inside.
        gain: Scale of the rule's step, from the pivot to the landing point.
        balance: Displacement of the base against the capture point, as a ratio of that point's
            distance from the middle of the feet; it loads the edges of both feet.
        trunk: Backward pitch of the trunk per forward distance of the capture point from the
            stance foot during a swing, rad/m: it keeps room for the swinging hip.
        way: Name of the default rule.
        rule: Dampings that replace those of the built-in rules, by name; see
            `windup.control.stepping.step_decision.StepRule`.
        patience: Minimum time of standing still before a comfort step, s.
        comfort: Maximum distance of a foot from its nominal place without a comfort step, m.
        relax: Times and tolerances of comfort steps.
        foot: What decides which foot steps: its distance from the desired `landing` point, or that
            from the predicted `capture` point, where a second step with the same foot counts as
            `windup.control.stepping.step_decision.AGAIN` m farther.
        rate: Rate of the control loop, Hz; the robot's own by default.
        support: Support region of the soles: the hull of their points, or Kenwright's circles and
            capsule about their centres, of the same area.
        clear: Minimum distance of the soles from forbidden ground, m.
        catch: Pushes during a walk that are answered by steps; None for no such push.
    """

    stance: str
    reach: ReachTable
    duration: Positive
    lift: Metres
    up: Fraction = 0.5
    early: Fraction = 0.6
    late: Positive = 1.0
    update: Fraction = 0.5
    dwell: Seconds = 0.05
    settle: Seconds = 0.4
    lead: Seconds = 0.0
    slack: float = 0.0
    gain: Positive = 1.0
    balance: float = 0.0
    trunk: float = 0.0
    way: str = "momentum"
    rule: dict[str, RuleTable] = {}
    patience: Seconds = 0.6
    comfort: Metres = 0.015
    relax: ComfortTable = ComfortTable()
    foot: Literal["landing", "capture"] = "landing"
    rate: Positive | None = None
    support: Support = "hull"
    clear: Metres = 0.015
    catch: CatchTable | None = None

    def find_rule(self, name: str) -> StepRule:
        """Return the rule `name`, with this robot's dampings if `rule` has them.

        Raises:
            UnknownNameError: There is no such rule.
        """
        rule = find_rule(name)
        if (own := self.rule.get(name)) is None:
            return rule
        return StepRule(name, own.when, own.where)
