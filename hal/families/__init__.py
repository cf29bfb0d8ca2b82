"""Families of servos: one object each with all that differs between makers."""

from windup.hal.errors import UnknownNameError
from windup.hal.families.dynamixel_1 import DYNAMIXEL_1
from windup.hal.families.dynamixel_x import DYNAMIXEL_X
from windup.hal.families.family import Block, Family, RequiredSetting
from windup.hal.families.feetech import FEETECH_SCS, FEETECH_STS

FAMILIES = (DYNAMIXEL_X, DYNAMIXEL_1, FEETECH_STS, FEETECH_SCS)

_OF_MODEL = {name: family for family in FAMILIES for name in family.numbers.values()}


def family_of(model: str) -> Family:
    """Return the family of a servo model; a suffix after a dash, such as its winding, is ignored.

    >>> family_of("STS3215-7.4V").name, family_of("MX-28").name
    ('Feetech STS', 'Dynamixel AX/MX')

    Raises:
        UnknownNameError: No family has such a model.
    """
    name = model if model in _OF_MODEL else model.split("-")[0]
    try:
        return _OF_MODEL[name]
    except KeyError:
        raise UnknownNameError("servo", model, _OF_MODEL) from None


__all__ = [
    "DYNAMIXEL_1",
    "DYNAMIXEL_X",
    "FAMILIES",
    "FEETECH_SCS",
    "FEETECH_STS",
    "Block",
    "Family",
    "RequiredSetting",
    "family_of",
]
