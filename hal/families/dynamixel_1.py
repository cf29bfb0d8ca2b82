"""Dynamixel AX and MX with protocol 1, also mixed on one bus, as in Poppy and Darwin."""

from windup.hal.families.family import Block, Family, RequiredSetting, RestartMark
from windup.hal.families.gain import Gain, slope_pair, slope_steps
from windup.hal.families.servo_protocol import Dynamixel1
from windup.hal.protocols.protocol1 import LONGEST_DYNAMIXEL
from windup.hal.servos.mx import MX
from windup.hal.servos.mx_registers import (
    BAUD_CODES,
    COMMON,
    FAST_CODES,
    HARDWARE_ERRORS,
    NUMBERS,
    mx_registers,
)
from windup.hal.servos.servo_model import ServoModel

FULL = 1023
"""Maximum torque limit: no limitation."""
MARKED = FULL - 1
"""Torque limit set by arming, to detect a restart, which loads `max_torque`; a shutdown sets 0."""
STATE = (
    COMMON["present_position"],
    COMMON["present_velocity"],
    COMMON["present_load"],
)

_P_GAIN = Gain(mx_registers("MX-28")["position_p_gain"], 254)
_SLOPES = Gain(mx_registers("AX-12A")["compliance_slopes"], 512, slope_steps, slope_pair)


def _required(model: ServoModel) -> tuple[RequiredSetting, ...]:
    """Return the required settings; those that a model does not have are skipped."""
    return (
        RequiredSetting("return_delay", 0),
        RequiredSetting("drive_mode", 0),
        RequiredSetting("min_position_limit", 0),
        RequiredSetting("max_position_limit", model.last_count),
        RequiredSetting("multi_turn_offset", 0),
        RequiredSetting("resolution_divider", 1),
        RequiredSetting("max_torque", FULL),
        RequiredSetting("status_return_level", 2),
        RequiredSetting("torque_mode", 0),
        RequiredSetting("torque_limit", MARKED),
        RequiredSetting("goal_speed", 0),  # no limit
        RequiredSetting("goal_acceleration", 0),
        RequiredSetting("position_i_gain", 0),
        RequiredSetting("position_d_gain", 0),
        RequiredSetting("cw_compliance_margin", 0),
        RequiredSetting("ccw_compliance_margin", 0),
    )


def _gain(model: str) -> Gain:
    return _SLOPES if "compliance_slopes" in mx_registers(model) else _P_GAIN


DYNAMIXEL_1 = Family(
    name="Dynamixel AX/MX",
    protocol_name="dynamixel1",
    protocol=Dynamixel1(COMMON["model_number"], COMMON["firmware_version"], LONGEST_DYNAMIXEL),
    registers=COMMON,
    table=mx_registers,
    numbers=NUMBERS,
    models=MX,
    bauds=BAUD_CODES | FAST_CODES,
    state=Block(36, 6, STATE),
    health=Block(36, 8, STATE),
    check=Block(24, 20, STATE),
    required=_required,
    gain=_gain,
    alert=sum(1 << bit for bit in HARDWARE_ERRORS),
    errors=HARDWARE_ERRORS,
    shutdown="shutdown",
    torque_bytes=12,
    torque=("torque_enable", "torque_limit"),
    restart_mark=RestartMark("torque_limit", FULL, MARKED),
    latching=True,
)
