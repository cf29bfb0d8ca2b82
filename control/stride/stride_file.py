"""Format of a robot's `stride.toml`: parameters of walking with a pendulum plan. SI units."""

from windup.control.stride.pendulum import StepTiming
from windup.hal.config import Fraction, Positive, TomlRecord
from windup.hal.config import NotNegative as Gain


class Stride(TomlRecord, frozen=True, kw_only=True):
    """Parameters of walking with a pendulum plan, for a robot with position servos.

    Attributes:
        stance: Name of the pose that the robot starts from, soles flat.
        begin: Time to shift the weight onto the first stance foot, s.
        single: Duration of single support, s.
        double: Duration of double support, s.
        lift: Height to which a foot is lifted, m.
        early: Shift of the highest point to an earlier time in the swing; see
            `windup.control.execution.swing.lift`.
        width: Nominal lateral distance of the feet, m.
        lead: Time by which the goals of the swing foot are ahead, against the servos' lag, s.
        quicken: Maximum change of the velocity from one step to the next, m/s.
        height: Height of the base above the soles, m.
        fastest: Maximum commanded speed, m/s.
        longest: Maximum forward or backward distance of the feet, m.
        narrowest: Minimum lateral distance of the feet, m.
        widest: Maximum lateral distance of the feet, m.
        turn: Maximum yaw between the feet, rad.
        yielding: Rate at which the planned CoM is drawn to the measured CoM, 1/s; only the capture
            point has to follow the plan exactly.
        adjust: Gain from the predicted capture point error at touchdown to the displacement of
            the landing place.
        update: Fraction of the swing until which the landing place is adjusted.
        most: Maximum displacement of the landing place per axis, m.
        keep: Time constant in which a position lag is made up for, s.
        feel: Time constant of the low-pass filter on the ground normal, s.
        hold: Proportional gain on the CoM position error.
        brake: Derivative gain on the CoM velocity error, s.
        level: Proportional gain on the tilt of the base.
        steady: Derivative gain on the tilt rate of the base, s.
        follow: Integral gain on the CoM error and on the tilt, 1/s.
        slow: Time constant of the low-pass filter on the gravity torques, s.
    """

    stance: str
    begin: Positive
    single: Positive
    double: Positive
    lift: Positive
    early: Fraction
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
    update: Fraction
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
        """Timing and bounds of the steps."""
        return StepTiming(
            self.single,
            self.double,
            self.width,
            self.longest,
            self.narrowest,
            self.widest,
            self.turn,
        )
