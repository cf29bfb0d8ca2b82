"""The IMU of an Open Duck Mini v2: a BNO055 on I2C, mounted upside down.

Mode (IMU: fusion without the magnetometer) and axes are those that its own runtime sets
(apirrone/Open_Duck_Mini_Runtime, raw_imu.py, `upside_down`). One mounted the other way up has
`mounting = ["-y", "x", "z"]`.
"""

from dataclasses import replace

from windup.hal.imu.bno055 import BNO055

OPEN_DUCK = replace(BNO055, name="open_duck", axes=("-y", "-x", "-z"))
