"""Families of servos: one object each with all that differs between makers."""

from windup.hal.families.catalogue import (
    FAMILIES,
    families,
    family_of,
    is_servo,
    servo_model,
    servo_names,
)
from windup.hal.families.dynamixel_1 import DYNAMIXEL_1
from windup.hal.families.dynamixel_x import DYNAMIXEL_X
from windup.hal.families.family import Block, Family, RequiredSetting, RestartMark
from windup.hal.families.feetech import FEETECH_SCS, FEETECH_STS
from windup.hal.families.gain import Gain
from windup.hal.families.plain_family import plain_family

__all__ = [
    "DYNAMIXEL_1",
    "DYNAMIXEL_X",
    "FAMILIES",
    "FEETECH_SCS",
    "FEETECH_STS",
    "Block",
    "Family",
    "Gain",
    "RequiredSetting",
    "RestartMark",
    "families",
    "family_of",
    "is_servo",
    "plain_family",
    "servo_model",
    "servo_names",
]
