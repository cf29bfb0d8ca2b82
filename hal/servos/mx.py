"""Data sheets of ROBOTIS Dynamixel AX and MX with protocol 1 (other MX firmware has protocol 2).

Torque, speed and current are the rows of the e-Manual. MX: ``duty = P / 8 x counts / 511``,
confirmed by an oscilloscope (Rhoban bam: 0.158). The duty of an AX rises from 0 to 1 over its
compliance slope, in counts; the manual equates a slope with an MX's P of 1024 / slope, which is
its P register here. Its punch, a step of duty at the goal, is not modelled.

Armature and friction of MX-64 and MX-106 are those of bam's models M1 (Apache-2.0). There is no
published fit of AX-12A or MX-28: they use those of the MX-64, scaled by stall torque.
"""

from math import pi

from windup.hal.servos.servo_model import DatasheetRow, ProtectionLimits, ServoModel

GAIN = 4096 / (2.0 * pi) / 8 / 511
"""Duty per rad of error and unit of P: 0.1595."""
AX_COUNTS_PER_REV = 1024 * 360 / 300
AX_GAIN = AX_COUNTS_PER_REV / (2.0 * pi) / 1024
"""Duty per rad of error and unit of 1024 / slope: 0.1910."""
MAX_DUTY = 0.9625

AX_12A = (DatasheetRow.of(12.0, 1.5, 59, 1.5),)
MX_28 = (
    DatasheetRow.of(11.1, 2.3, 50, 1.3),
    DatasheetRow.of(12.0, 2.5, 55, 1.4),
    DatasheetRow.of(14.8, 3.1, 67, 1.7),
)
MX_64 = (
    DatasheetRow.of(11.1, 5.5, 58, 3.9),
    DatasheetRow.of(12.0, 6.0, 63, 4.1),
    DatasheetRow.of(14.8, 7.3, 78, 5.2),
)
MX_106 = (
    DatasheetRow.of(11.1, 8.0, 41, 4.8),
    DatasheetRow.of(12.0, 8.4, 45, 5.2),
    DatasheetRow.of(14.8, 10.0, 55, 6.3),
)

AX_LIMITS, MX_LIMITS = ProtectionLimits(70.0, 6.0, 14.0), ProtectionLimits(80.0, 6.0, 16.0)
"""Initial values of registers 11 to 13 in the e-Manual."""

# name, model number, rows, duty per rad and P, default P, armature kg m2, friction N m
MX = (
    ServoModel(
        "AX-12A",
        12,
        AX_12A,
        AX_GAIN,
        32,
        0.003,
        0.0226,
        AX_COUNTS_PER_REV,
        1.0,
        1024,
        limits=AX_LIMITS,
    ),
    ServoModel("MX-28", 29, MX_28, GAIN, 32, 0.005, 0.0377, pwm_limit=MAX_DUTY, limits=MX_LIMITS),
    ServoModel(
        "MX-64", 310, MX_64, GAIN, 32, 0.01195, 0.0904, pwm_limit=MAX_DUTY, limits=MX_LIMITS
    ),
    ServoModel(
        "MX-106", 320, MX_106, GAIN, 32, 0.0266, 0.1035, pwm_limit=MAX_DUTY, limits=MX_LIMITS
    ),
)
