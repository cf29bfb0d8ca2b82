"""Repairs a status return level at which a servo answers pings only, or reads only.

At level 0 a servo answers a ping and nothing else. The required level is written with a sync write,
which is never answered whatever the level is, and then read back.
"""

from windup.hal.bus.bus import Bus
from windup.hal.errors import HardwareError, NoAnswerError
from windup.hal.servos.servo_model import ServoModel

REGISTER = "status_return_level"


def enable_answers(bus: Bus, id: int, model: ServoModel) -> str:
    """Make a servo answer reads and writes; return a description of the change, or "".

    Raises:
        HardwareError: It still answers nothing but pings, or reads back another level.
    """
    register = bus.family.registers.get(REGISTER)
    settings = bus.family.required(model)
    wanted = next((setting.value for setting in settings if setting.name == REGISTER), None)
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
        bus.sync_write(lock, {id: 1})  # locked: kept in RAM, no EEPROM wear
    bus.sync_write(register, {id: wanted})
    try:
        now = bus.read(id, register)
    except NoAnswerError:
        raise HardwareError("answers only pings, even with its status return level set") from None
    if now != wanted:
        raise HardwareError(f"{REGISTER} was set to {wanted} and reads back as {now}")
    before = "unreadable (answers only pings)" if present is None else str(present)
    return f"{REGISTER} {before} -> {wanted}"
