"""`stepping.toml` of a robot: how it steps when a push asks for it. SI units."""

from typing import Annotated, Literal

from msgspec import Meta

from windup.control.stepping.step_decision import Damping, Reach, StepRule, find_rule
from windup.hal.config import Part, Positive, Record, Seconds
from windup.hal.joints import Array

Metres = Annotated[float, Meta(ge=0.0, le=100.0)]
Support = Literal["hull", "capsule"]


class ReachTable(Record, frozen=True):
    """Where a foot may be put, seen from the other one, m.

    See `windup.control.stepping.step_decision.Reach`.
    """

    back: Annotated[float, Meta(le=0.0)]
    front: Metres
    near: Metres
    far: Metres

    def reach(self) -> Reach:
        """Return what the decision works with."""
        return Reach(self.back, self.front, self.near, self.far)


class RuleTable(Record, frozen=True):
    """A rule's dampings, omega; without `where` the foot goes where the capture point will be."""

    when: Damping
    where: Damping | None = None


class CatchTable(Record, frozen=True):
    """Which pushes on a walk are for steps, by how far they throw the capture point off its way.

    Attributes:
        back: Backward by more than this, m.
        slant: But to the side by no more than this part of that.
    """

    back: Positive
    slant: Positive

    def meets(self, thrown: Array) -> bool:
        """Return whether it is `thrown` (2,) m, ahead and to the left, far enough."""
        ahead, left = thrown
        return bool(-ahead > self.back and abs(left) < -ahead * self.slant)


class Stepping(Record, frozen=True):
    """How a robot steps; `up`, `lead`, `balance` and `trunk` are for servos alone.

    Attributes:
        stance: Name of the pose that it stands in, soles flat.
        reach: Where a foot may be put.
        duration: Of a step, s.
        lift: How high the foot is lifted, m.
        up: The part of the step after which the foot comes down again.
        early: The part of the step after which a foot that touches has landed.
        update: The part of the step in which the target is still decided anew.
        dwell: Time on both feet between two steps, s.
        settle: Time in which the base comes back over the feet, s.
        lead: Goals are for so much later, because servos lag, s.
        slack: How far the trigger point may be outside the support, m; negative is inside.
        gain: How far the foot goes beyond or short of what the rule says, from the pivot.
        balance: How far the base is moved against the capture point, in parts of the way of that
            point from the middle of the feet; both feet press on their edges.
        trunk: How much the trunk turns backward as the capture point runs away forward, while
            one foot is in the air, rad/m: it keeps room for the hip that swings.
        way: How pushes are met where nobody says it: the name of a rule.
        rule: Other dampings of the rules, by their names; see
            `windup.control.stepping.step_decision.StepRule`.
        patience: How long a robot stands still before it takes a comfort step, s.
        comfort: How far a foot may stand from its nominal place, m.
        rate: Of the loop, Hz; the robot's own by default.
        support: What the soles support: the hull of their points, or Kenwright's circles and
            capsule about their middles, as large.
        clear: How far soles keep off ground where they must not come down, m.
        catch: When a push on a walk is one for steps; None where steps are no help to it.
        torque: Largest torque that whole-body control asks of a joint with ideal torque, N m.
    """

    stance: str
    reach: ReachTable
    duration: Positive
    lift: Metres
    up: Part = 0.5
    early: Part = 0.6
    update: Part = 0.5
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
    rate: Positive | None = None
    support: Support = "hull"
    clear: Metres = 0.015
    catch: CatchTable | None = None
    torque: Positive = 1e3

    def find_rule(self, name: str) -> StepRule:
        """Return a rule by its name, with the dampings of this robot where it has its own.

        Raises:
            UnknownNameError: There is no such rule.
        """
        rule = find_rule(name)
        if (own := self.rule.get(name)) is None:
            return rule
        return StepRule(name, own.when, own.where)
