"""`stride.toml` of a robot: how it walks as the inverted pendulum plans it. SI units."""

from windup.control.stride.pendulum import StepTiming
from windup.hal.config import NotNegative as Gain
from windup.hal.config import Part, Positive, Record


class Stride(Record, frozen=True, kw_only=True):
    """How a robot with position servos strides.

    Attributes:
        stance: Name of the pose that it starts from, soles flat.
        begin: Time in which the weight goes over the first foot that stays, s.
        single: Time on one foot, s.
        double: Time on both, s.
        lift: How high a foot is lifted, m.
        early: How much sooner than in the middle of the swing that is; see
            `windup.control.footprints.swing.lift`.
        width: From one foot to the other beside it, m.
        lead: The foot in the air is told where it should be so much later, for servos lag, s.
        quicken: Most that the speed changes from one step to the next, m/s.
        height: Of the base above the soles, m.
        fastest: Most speed that it takes orders for, m/s.
        longest: Farthest that a foot goes before or behind the other one, m.
        narrowest: Nearest beside it, m.
        widest: Farthest beside it, m.
        turn: Most that a foot is turned against the other one, rad.
        yielding: Rate at which the planned centre of mass goes to where it is measured, 1/s; the
            capture point is what has to be where it is planned.
        adjust: Part of the way that the capture point will have strayed when the foot lands, by
            which that foot lands elsewhere.
        update: The part of the swing in which it is still decided anew.
        most: Most that a foot lands elsewhere, m.
        keep: Time in which it makes up for being behind where it should be, s.
        feel: Time in which the standing sole tells how the ground lies, s.
        hold: Proportional gain on the CoM error.
        brake: Derivative gain on the CoM, s.
        level: Part of the tilt of the base that the goals lean against it.
        steady: Time by which the rate of that tilt does so, s.
        follow: Rate at which what lasts of either is made up for, 1/s.
        slow: Time constant of the torques that hold the weight, s.
    """

    stance: str
    begin: Positive
    single: Positive
    double: Positive
    lift: Positive
    early: Part
    width: Positive
    lead: Gain
    quicken: Positive
    height: Positive
    fastest: Positive
    longest: Positive
    narrowest: Positive
    widest: Positive
    turn: Positive
    yielding: Gain
    adjust: Gain
    update: Part
    most: Positive
    keep: Positive
    feel: Positive
    hold: Gain
    brake: Gain
    level: Gain
    steady: Gain
    follow: Gain
    slow: Positive

    @property
    def pace(self) -> StepTiming:
        """Its steps."""
        return StepTiming(
            self.single,
            self.double,
            self.width,
            self.longest,
            self.narrowest,
            self.widest,
            self.turn,
        )
