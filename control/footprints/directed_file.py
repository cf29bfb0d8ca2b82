"""`footprints.toml` of a robot: how it walks footprints. SI units."""

from math import inf

from windup.hal.config import NotNegative as Gain
from windup.hal.config import Positive, Record


class Directed(Record, frozen=True, kw_only=True):
    """How a robot walks footprints.

    Attributes:
        stance: Name of the pose that it starts from, soles flat.
        shift: Time in which the weight goes onto the foot that stays, s.
        swing: Time of the other one in the air, where its footprint gives none, s.
        land: Time until that one bears, s.
        lift: How high it is lifted, m.
        height: Of the base above the soles, m.
        near: The weight is over a foot when the centre of mass is so near to its middle, m,
        quiet: and no faster than this, m/s.
        pace: Most acceleration of the centre of mass on its way from foot to foot, m/s2; what
            is far takes longer than `shift`.
        patience: After so many times `shift` the step begins all the same.
        close: A foot is where it should be when it is so near to its place, m,
        turned: and turned no more from it than this, degrees.
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
    """How a robot with position servos does so.

    Attributes:
        hold: Proportional gain on the CoM error.
        brake: Derivative gain on the CoM, s.
        level: Part of the tilt of the base that the goals lean against it.
        steady: Time by which the rate of that tilt does so, s.
        follow: Rate at which what lasts of either is made up for, 1/s.
        slow: Time constant of the torques that hold the weight, s.
    """

    hold: Gain
    brake: Gain
    level: Gain
    steady: Gain
    follow: Gain
    slow: Positive
