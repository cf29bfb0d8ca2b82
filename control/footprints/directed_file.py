"""Format of a robot's `footprints.toml`: times, tolerances and gains for footprints. SI units."""

from math import inf

from windup.hal.config import NotNegative as Gain
from windup.hal.config import Positive, TomlRecord


class Directed(TomlRecord, frozen=True, kw_only=True):
    """Times, distances and tolerances of steps to footprints.

    Attributes:
        stance: Name of the pose that the robot starts from, soles flat.
        shift: Time to shift the weight onto the stance foot, s.
        swing: Time of the swing foot in the air if its footprint gives none, s.
        land: Time from touchdown until the swing foot bears load, s.
        lift: Height to which the swing foot is lifted, m.
        height: Height of the base above the soles, m.
        near: Maximum distance of the CoM from its goal for a weight shift to be complete, m.
        quiet: Maximum speed of the CoM for a weight shift to be complete, m/s.
        pace: Maximum acceleration of the CoM during a weight shift, m/s2; long shifts therefore
            take longer than `shift`.
        patience: Time-out of a weight shift, in multiples of its duration; then the step begins.
        close: Maximum distance of a foot that counts as placed from its footprint, m.
        turned: Maximum yaw error of a foot that counts as placed, degrees.
    """

    stance: str
    shift: Positive
    swing: Positive
    land: Positive
    lift: Positive
    height: Positive
    near: Positive
    quiet: Positive
    pace: Positive = inf
    patience: Positive = 3.0
    close: Positive = 0.01
    turned: Positive = 5.0


class ServoDirected(Directed, frozen=True, kw_only=True):
    """The same for a robot with position servos, with its feedback gains.

    Attributes:
        hold: Proportional gain on the CoM position error.
        brake: Derivative gain on the CoM velocity error, s.
        level: Proportional gain on the tilt of the base.
        steady: Derivative gain on the tilt rate of the base, s.
        follow: Integral gain on the CoM error and on the tilt, 1/s.
        slow: Time constant of the low-pass filter on the gravity torques, s.
    """

    hold: Gain
    brake: Gain
    level: Gain
    steady: Gain
    follow: Gain
    slow: Positive
