"""Servos that obey in silence: a status return level that answers nothing, or reads alone.

Such a servo answers a ping and looks dead to everything else. The level is written as a sync write,
which no servo answers whatever its level is, and read back.
"""

from windup.hal.bus.bus import Bus
from windup.hal.errors import HardwareError, NoAnswerError
from windup.hal.servos.servo_model import ServoModel

REGISTER = "status_return_level"


def make_answer(bus: Bus, id: int, model: ServoModel) -> str:
    """Have a servo answer to reads and writes; return what was changed, or "".

    Raises:
        HardwareError: It answers to nothing but pings all the same.
    """
    register = bus.family.registers.get(REGISTER)
    wanted = next((want.value for want in bus.family.wanted(model) if want.name == REGISTER), None)
    if register is None or wanted is None:
        return ""
    try:
        present = bus.read(id, register)
    except NoAnswerError:
        present = None
    if present == wanted:
        return ""
    lock = bus.family.registers.get("lock")
    if lock is not None and register.area == "eeprom":
        bus.sync_write(lock, {id: 1})  # so it holds until the power goes, and wears nothing
    bus.sync_write(register, {id: wanted})
    try:
        now = bus.read(id, register)
    except NoAnswerError:
        raise HardwareError(
            "answers to pings alone, also with its status return level set"
        ) from None
    if now != wanted:
        raise HardwareError(f"{REGISTER} was set to {wanted} and reads back as {now}")
    before = "one that answers to pings alone" if present is None else str(present)
    return f"{REGISTER} {before} -> {wanted}"
