"""All servo families and models: those of Windup, and those that other distributions add.

The latter are imported only when a name is not one of Windup's, or when all are asked for.
"""

from windup.hal.errors import UnknownNameError
from windup.hal.families.added import check_added
from windup.hal.families.dynamixel_1 import DYNAMIXEL_1
from windup.hal.families.dynamixel_x import DYNAMIXEL_X
from windup.hal.families.family import Family
from windup.hal.families.feetech import FEETECH_SCS, FEETECH_STS
from windup.hal.plugins.plugins import Plugins
from windup.hal.servos.servo_model import ServoModel

FAMILIES = (DYNAMIXEL_X, DYNAMIXEL_1, FEETECH_STS, FEETECH_SCS)
"""The families of Windup itself."""
_OWN_MODELS = {model.name: model for family in FAMILIES for model in family.models}
_OWN_NAMES = {name: family for family in FAMILIES for name in family.numbers.values()}


def _accept(name: str, found: object) -> Family:
    """Return a family that an entry point names; see `Plugins`."""
    return check_added(found, FAMILIES)


ADDED_FAMILIES: Plugins[Family] = Plugins("windup.servos", _accept)
"""The families that other distributions add."""


def families() -> tuple[Family, ...]:
    """Return all families; those that other distributions add are imported now, and come last."""
    return (*FAMILIES, *ADDED_FAMILIES.all().values())


def family_of(model: str) -> Family:
    """Return the family of a servo model; a suffix after a dash, such as its winding, is ignored.

    >>> family_of("STS3215-7.4V").name, family_of("MX-28").name
    ('Feetech STS', 'Dynamixel AX/MX')

    Raises:
        UnknownNameError: No family has such a model.
    """
    names = (model, model.split("-")[0])
    for name in names:
        if name in _OWN_NAMES:
            return _OWN_NAMES[name]
    known = {name: family for family in families() for name in family.numbers.values()}
    for name in names:
        if name in known:
            return known[name]
    raise UnknownNameError("servo", model, known)


def is_servo(name: str) -> bool:
    """Return whether there is a servo model `name`.

    >>> is_servo("XL430-W250"), is_servo("XL430")
    (True, False)
    """
    return name in _OWN_MODELS or name in _all_models()


def servo_names() -> tuple[str, ...]:
    """Return the names of all servo models."""
    return tuple(_all_models())


def servo_model(name: str) -> ServoModel:
    """Return the servo model `name`.

    >>> servo_model("XL430-W250").model_number
    1060

    Raises:
        UnknownNameError: There is no such model; the message suggests the likely one.
    """
    if name in _OWN_MODELS:
        return _OWN_MODELS[name]
    models = _all_models()
    if name not in models:
        raise UnknownNameError("servo", name, models)
    return models[name]


def _all_models() -> dict[str, ServoModel]:
    return {model.name: model for family in families() for model in family.models}
