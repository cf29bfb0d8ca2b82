"""Data sheets of ROBOTIS Dynamixel X.

Torque, speed and current are the rows of the ROBOTIS e-Manual (each servo's own page). Its page on
the position controller gives ``pwm = P / 128 x counts of error``, full scale 885; the XL330 was
measured to divide by 256 (Rhoban bam, Apache-2.0), while the manual says 128.

The protection limits (Temperature Limit 31, Min and Max Voltage Limit 34 and 32) are the initial
values on each servo's own page.

Armature and friction are from published fits, if there are any: XM430-W350 from the OP3 of
mujoco_menagerie (Apache-2.0; its damping of 1.084 N m s/rad already includes the back-EMF, so no
joint damping is added), XL330 from bam's model M1, the XC and 2X servos and XM430-W210 from
ToddlerBot (MIT). The others use values of the nearest motor, as stated in a comment: armature
scales with the square of the gear ratio, friction with the ratio.
"""

from math import pi

from windup.hal.servos.servo_model import DatasheetRow, ProtectionLimits, ServoModel

COUNTS_PER_RAD = 4096 / (2.0 * pi)
FULL_SCALE = 885
GAIN = COUNTS_PER_RAD / 128 / FULL_SCALE
"""Duty per rad of error and unit of P: 0.005755."""

XM430_W350 = (
    DatasheetRow.of(11.1, 3.8, 43, 2.1),
    DatasheetRow.of(12.0, 4.1, 46, 2.3),
    DatasheetRow.of(14.8, 4.8, 57, 2.7),
)
XM430_W210 = (
    DatasheetRow.of(11.1, 2.7, 70, 2.1),
    DatasheetRow.of(12.0, 3.0, 77, 2.3),
    DatasheetRow.of(14.8, 3.7, 95, 2.7),
)
XL430_W250 = (
    DatasheetRow.of(9.0, 1.0, 47, 1.0),
    DatasheetRow.of(11.1, 1.4, 57, 1.3),
    DatasheetRow.of(12.0, 1.5, 61, 1.4),
)
XC430_W240 = (
    DatasheetRow.of(9.0, 1.4, 52, 1.1),
    DatasheetRow.of(11.1, 1.7, 65, 1.3),
    DatasheetRow.of(12.0, 1.9, 70, 1.4),
)
TWO_XC430 = (
    DatasheetRow.of(9.0, 1.3, 48, 1.1),
    DatasheetRow.of(11.1, 1.6, 59, 1.3),
    DatasheetRow.of(12.0, 1.8, 64, 1.4),
)
XC330_T288 = (
    DatasheetRow.of(9.0, 0.76, 52, 0.61),
    DatasheetRow.of(11.1, 0.92, 65, 0.80),
    DatasheetRow.of(12.0, 1.0, 71, 0.88),
)
XC330_M288 = (
    DatasheetRow.of(3.7, 0.69, 59, 1.34),
    DatasheetRow.of(5, 0.93, 81, 1.8),
    DatasheetRow.of(6, 1.1, 97, 2.15),
)
XL330_M288 = (
    DatasheetRow.of(3.7, 0.42, 76, 1.11),
    DatasheetRow.of(5.0, 0.52, 103, 1.47),
    DatasheetRow.of(6.0, 0.6, 123, 1.74),
)
XC430_W150 = (
    DatasheetRow.of(9.0, 1.2, 80, 1.1),
    DatasheetRow.of(11.1, 1.4, 99, 1.3),
    DatasheetRow.of(12.0, 1.6, 106, 1.4),
)
XL330_M077 = (
    DatasheetRow.of(3.7, 0.18, 278, 1.11),
    DatasheetRow.of(5.0, 0.215, 383, 1.47),
    DatasheetRow.of(6.0, 0.228, 456, 1.74),
)
XM540_W150 = (
    DatasheetRow.of(11.1, 6.9, 50, 4.2),
    DatasheetRow.of(12.0, 7.3, 53, 4.4),
    DatasheetRow.of(14.8, 8.9, 66, 5.5),
)
XM540_W270 = (
    DatasheetRow.of(11.1, 10.0, 28, 4.2),
    DatasheetRow.of(12.0, 10.6, 30, 4.4),
    DatasheetRow.of(14.8, 12.9, 37, 5.5),
)
XH540_W270 = (
    DatasheetRow.of(11.1, 9.2, 36, 4.5),
    DatasheetRow.of(12.0, 9.9, 39, 4.9),
    DatasheetRow.of(14.8, 11.7, 46, 5.9),
)

XM, XC430 = ProtectionLimits(80.0, 9.5, 16.0), ProtectionLimits(80.0, 6.0, 16.0)
XL430, XC330_T = ProtectionLimits(72.0, 6.0, 14.0), ProtectionLimits(70.0, 5.5, 14.0)
X330_M = ProtectionLimits(70.0, 3.5, 7.0)

# name, model number, rows, duty per rad and P, default P, armature kg m2, friction N m
X_SERIES = (
    ServoModel("XM430-W350", 1020, XM430_W350, GAIN, 800, 0.045, 0.03, limits=XM),
    ServoModel("XM430-W210", 1030, XM430_W210, GAIN, 800, 0.0012, 0.134, limits=XM),
    # armature and friction of the 2XL430
    ServoModel("XL430-W250", 1060, XL430_W250, GAIN, 640, 0.0042, 0.292, limits=XL430),
    # default P of the XL430
    ServoModel("2XL430-W250", 1090, XL430_W250, GAIN, 640, 0.0042, 0.292, limits=XL430),
    ServoModel("XC430-W240", 1080, XC430_W240, GAIN, 700, 0.004, 0.069, limits=XC430),
    # default P of the XC430
    ServoModel("2XC430-W250", 1160, TWO_XC430, GAIN, 700, 0.0044, 0.252, limits=XC430),
    # division by 128 not verified by measurement
    ServoModel("XC330-T288", 1220, XC330_T288, GAIN, 900, 0.0035, 0.014, limits=XC330_T),
    # armature and friction of the XC330-T288
    ServoModel("XC330-M288", 1240, XC330_M288, GAIN, 900, 0.0035, 0.014, limits=X330_M),
    ServoModel("XL330-M288", 1200, XL330_M288, GAIN / 2, 400, 0.0018, 0.0128, limits=X330_M),
    # armature and friction scaled by gear ratio: 159.6, XC430-W240 245.2
    ServoModel("XC430-W150", 1070, XC430_W150, GAIN, 460, 0.0017, 0.045, limits=XC430),
    # armature and friction scaled by gear ratio: 77.5, XL330-M288 288.4
    ServoModel("XL330-M077", 1190, XL330_M077, GAIN / 2, 400, 0.00013, 0.0034, limits=X330_M),
    # no published fit: armature and friction of the XM430-W350
    ServoModel("XM540-W270", 1120, XM540_W270, GAIN, 800, 0.045, 0.03, limits=XM),
    # armature and friction scaled by gear ratio: 152.3, XM540-W270 272.5
    ServoModel("XM540-W150", 1130, XM540_W150, GAIN, 800, 0.0141, 0.0168, limits=XM),
    # no published fit: armature and friction of the XM430-W350
    ServoModel("XH540-W270", 1100, XH540_W270, GAIN, 800, 0.045, 0.03, limits=XM),
)
