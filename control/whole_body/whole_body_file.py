"""Format of a robot's `whole_body.toml`: weights and gains of whole-body control. SI units."""

from windup.hal.config import NotNegative, Positive, TomlRecord


class Weights(TomlRecord, frozen=True, kw_only=True):
    """Weights of the objectives, for errors of accelerations in m/s2 and rad/s2.

    Attributes:
        com: Weight of the acceleration of the centre of mass.
        angular: Weight of the horizontal angular momentum rates.
        vertical: Weight of the angular momentum rate about the vertical.
        posture: Weight of the joint accelerations toward the stance.
        trunk: Weight of the angular acceleration of the base.
        swing: Weight of the acceleration of a foot in the air.
        stance: Weight of the acceleration of a foot on the ground, which is to be zero.
    """

    com: NotNegative = 10.0
    angular: NotNegative = 1.0
    vertical: NotNegative = 1.0
    posture: NotNegative = 0.02
    trunk: NotNegative = 2.0
    swing: NotNegative = 30.0
    stance: NotNegative = 1000.0


class Feedback(TomlRecord, frozen=True, kw_only=True):
    """Feedback of an objective: acceleration = stiffness * error + damping * error of the rate.

    Attributes:
        stiffness: Gain on the error of position or attitude, 1/s2.
        damping: Gain on the error of velocity, 1/s.
    """

    stiffness: NotNegative
    damping: NotNegative


class WholeBodyFile(TomlRecord, frozen=True, kw_only=True):
    """Whole-body control of a robot with torque joints (Wu & Zordan 2010, section 5).

    Attributes:
        torque: Maximum torque of any joint, N m; a joint's own limit holds as well.
        friction: Coefficient of the friction pyramid.
        period: Period of the optimisation, s; inverse dynamics runs at every tick.
        com: Feedback of the centre of mass: k_L and d_L of Eq. 10.
        posture: Feedback of the joints and of the attitude of the trunk: k_T and d_T of Eq. 9.
        swing: Feedback of a foot in the air.
        spin: Damping of the angular momentum, d_z of Eq. 11, 1/s.
        still: Damping of a foot on the ground, 1/s.
        follow: Damping of every joint about its planned velocity, N m s/rad: without it a light
            foot that meets unexpected ground speeds away between two plans.
        touch: Maximum height of the lowest corner of a foot that has landed, m.
        weights: Weights of the objectives.
    """

    torque: Positive
    friction: Positive = 0.8
    period: Positive = 0.005
    com: Feedback = Feedback(stiffness=40.0, damping=12.0)
    posture: Feedback = Feedback(stiffness=100.0, damping=20.0)
    swing: Feedback = Feedback(stiffness=900.0, damping=60.0)
    spin: NotNegative = 5.0
    still: NotNegative = 20.0
    follow: NotNegative = 2.0
    touch: Positive = 0.003
    weights: Weights = Weights()
