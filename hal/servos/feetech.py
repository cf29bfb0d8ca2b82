"""Data sheets of Feetech STS and SCS.

The control law is ``duty = P x counts of error / 4000``: a duty of 0.16297 per rad and unit of P,
confirmed by an oscilloscope (Rhoban bam: 0.166) and K-Scale's fits (0.16293). Torque and speed are
from Feetech's data sheets; for the 7.4 V type they disagree with measurement (bam identifies
3.25 N m at 7.4 V), so measure the torque of a robot before relying on it. Armature and friction are
those of bam's model M1 of the 7.4 V type (Apache-2.0); there is no published physical fit of the
other two, which use the same values.

For the SCS0009, torque, speed and default gains have no cited source, and its control law, armature
and friction are not published: its entry uses the STS's law for the same angle, and the STS3215's
armature and friction scaled by stall torque. Identify it before relying on a twin of it.
"""

from math import pi

from windup.hal.servos.servo_model import DatasheetRow, ProtectionLimits, ServoModel

GAIN = 4096 / (2.0 * pi) / 4000
"""Duty per rad of error and unit of P: 0.16297."""

GOAL_SPEED = 3400 * 2.0 * pi / 4096
"""Maximum speed of the internal goal of an STS at factory defaults (measured by bam), rad/s."""

STS3215_7V4 = (DatasheetRow.of(6.0, 1.6, 55 * 6.0 / 7.4), DatasheetRow.of(7.4, 1.91, 55))
STS3215_12V = (DatasheetRow.of(12.0, 2.94, 45, 2.7),)
STS3250_12V = (DatasheetRow.of(12.0, 4.9, 75),)
SCS0009_6V = (DatasheetRow.of(6.0, 0.226, 100),)
SCS_COUNTS_PER_REV = 1024 * 360 / 300
LIMITS_7V4, LIMITS_12V = ProtectionLimits(70.0, 4.0, 8.0), ProtectionLimits(70.0, 4.0, 14.0)
"""Registers 13 to 15 of Feetech's memory tables; the maximum voltage depends on the winding."""

# name, model number, rows, duty per rad and P, default P, armature kg m2, friction N m
STS_MODELS = (
    ServoModel(
        "STS3215-7.4V", 777, STS3215_7V4, GAIN, 32, 0.0284, 0.0524,
        pwm_limit=0.97, goal_speed=GOAL_SPEED, limits=LIMITS_7V4,
    ),
    ServoModel(
        "STS3215-12V", 777, STS3215_12V, GAIN, 32, 0.0284, 0.0524,
        goal_speed=GOAL_SPEED, limits=LIMITS_12V,
    ),
    ServoModel(
        "STS3250", 2825, STS3250_12V, GAIN, 32, 0.0284, 0.0524,
        pwm_limit=0.97, goal_speed=GOAL_SPEED, limits=LIMITS_12V,
    ),
)  # fmt: skip
SCS_MODELS = (
    ServoModel(
        "SCS0009", 1284, SCS0009_6V, GAIN, 15, 0.0034, 0.0062, SCS_COUNTS_PER_REV, 0.97, 1024,
        limits=LIMITS_7V4,
    ),
)  # fmt: skip
