"""Feetech STS (and SMS): little-endian, 4096 counts; SCS: big-endian, 1024 counts.

Gains and limits are in the EEPROM area. While the register `lock` is 1, a write there is kept only
until power-off, so the loop may change gains without wearing the EEPROM.
"""

from windup.hal.families.factory_default import FactoryDefault, protective_limits
from windup.hal.families.family import Block, Family, RequiredSetting, RestartMark
from windup.hal.families.gain import Gain
from windup.hal.families.servo_protocol import Feetech
from windup.hal.servos.feetech import SCS_MODELS, STS_MODELS
from windup.hal.servos.feetech_registers import (
    BAUD_CODES,
    HARDWARE_ERRORS,
    MULTI_TURN,
    SCS,
    SCS_NUMBERS,
    STEP_SPEED,
    STS,
    STS_NUMBERS,
    feetech_registers,
)
from windup.hal.servos.servo_model import ServoModel

FULL = 1000
"""Maximum torque limit: no limitation."""
MARKED = FULL - 1
"""Torque limit set by arming, to detect a restart, which loads `max_torque` (memory table, 48)."""
OVERLOAD = 1 << 5
"""Bit of the only error that reduces torque, to Protective Torque (memory table, 34)."""
GUARDED = 1 << 2 | OVERLOAD
"""Unloading Condition bits required: overheating, overload (memory table, 19)."""
LARGEST_P = 254
_ALERT = sum(1 << bit for bit in HARDWARE_ERRORS)


def _sts_required(model: ServoModel) -> tuple[RequiredSetting, ...]:
    return (
        *_required(model),
        RequiredSetting("phase", STEP_SPEED, STEP_SPEED | MULTI_TURN),  # 1 step/s, single turn
        RequiredSetting("operating_mode", 0),
        RequiredSetting("angular_resolution", 1),  # otherwise a count is several steps
        RequiredSetting("cw_dead_zone", 1),
        RequiredSetting("ccw_dead_zone", 1),
        RequiredSetting("acceleration", 0),  # no profile
        RequiredSetting("torque_limit", MARKED),
    )


def _required(model: ServoModel) -> tuple[RequiredSetting, ...]:
    return (
        RequiredSetting("return_delay", 0),
        RequiredSetting("status_return_level", 1),
        RequiredSetting("min_position_limit", 0),
        RequiredSetting("max_position_limit", model.last_count),
        RequiredSetting("max_torque", FULL),
        RequiredSetting("unloading_condition", GUARDED, GUARDED),
        RequiredSetting("position_d_gain", 0),
        RequiredSetting("position_i_gain", 0),
        RequiredSetting("goal_time", 0),
        RequiredSetting("goal_speed", 0),  # no limit
        RequiredSetting("lock", 1),
    )


PROTECTION_DEFAULTS = (
    FactoryDefault("protection_current", 500),
    FactoryDefault("overload_torque", 80),
    FactoryDefault("protective_torque", 20),
    FactoryDefault("protection_time", 200),
    FactoryDefault("overcurrent_time", 200),
)
"""Factory defaults of the protection registers (memory table, 28 and 34 to 38)."""


def _factory_defaults(model: ServoModel) -> tuple[FactoryDefault, ...]:
    return *protective_limits(model), *PROTECTION_DEFAULTS


_STS_GAIN = Gain(STS["position_p_gain"], LARGEST_P)
_SCS_GAIN = Gain(SCS["position_p_gain"], LARGEST_P)


def _sts_gain(model: str) -> Gain:
    return _STS_GAIN


def _scs_gain(model: str) -> Gain:
    return _SCS_GAIN


_STS_STATE = (STS["present_position"], STS["present_velocity"], STS["present_load"])
_STS_CURRENT = (STS["present_position"], STS["present_velocity"], STS["present_current"])
_SCS_STATE = (SCS["present_position"], SCS["present_velocity"], SCS["present_load"])

FEETECH_STS = Family(
    name="Feetech STS",
    protocol_name="feetech",
    protocol=Feetech(STS["model_number"], STS["firmware_version"], always_sync=True),
    registers=STS,
    table=feetech_registers,
    numbers=STS_NUMBERS,
    models=STS_MODELS,
    bauds=BAUD_CODES,
    state=Block(56, 6, _STS_STATE),
    current=Block(56, 15, _STS_CURRENT),
    health=Block(56, 8, _STS_STATE),
    check=Block(40, 24, _STS_STATE),
    required=_sts_required,
    factory_defaults=_factory_defaults,
    gain=_sts_gain,
    alert=_ALERT,
    errors=HARDWARE_ERRORS,
    shutdown="unloading_condition",
    torque_bytes=10,
    torque=("torque_enable", "torque_limit"),
    restart_mark=RestartMark("torque_limit", FULL, MARKED),
    weakening=OVERLOAD,
)

FEETECH_SCS = Family(
    name="Feetech SCS",
    protocol_name="feetech",
    protocol=Feetech(SCS["model_number"], SCS["firmware_version"], always_sync=False),
    registers=SCS,
    table=feetech_registers,
    numbers=SCS_NUMBERS,
    models=SCS_MODELS,
    bauds=BAUD_CODES,
    state=Block(56, 6, _SCS_STATE),
    health=Block(56, 8, _SCS_STATE),
    check=Block(40, 24, _SCS_STATE),
    required=_required,
    factory_defaults=_factory_defaults,
    gain=_scs_gain,
    alert=_ALERT,
    errors=HARDWARE_ERRORS,
    shutdown="unloading_condition",
    torque_bytes=5,
    weakening=OVERLOAD,
)
