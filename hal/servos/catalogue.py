"""All supported servo models, by the name printed on them."""

from windup.hal.errors import UnknownNameError
from windup.hal.servos.feetech import FEETECH
from windup.hal.servos.mx import MX
from windup.hal.servos.servo_model import ServoModel
from windup.hal.servos.x_series import X_SERIES

_MODELS = {model.name: model for model in (*X_SERIES, *MX, *FEETECH)}


def servo_names() -> tuple[str, ...]:
    """Return the names of all supported servo models."""
    return tuple(_MODELS)


def servo_model(name: str) -> ServoModel:
    """Return the servo model `name`.

    >>> servo_model("XL430-W250").model_number
    1060

    Raises:
        UnknownNameError: There is no such model; the message suggests the likely one.
    """
    try:
        return _MODELS[name]
    except KeyError:
        raise UnknownNameError("servo", name, _MODELS) from None
