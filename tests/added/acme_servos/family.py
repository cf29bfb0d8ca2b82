from math import pi

from windup.hal.families import RequiredSetting, plain_family
from windup.hal.families.servo_protocol import Feetech
from windup.hal.registers import Register
from windup.hal.servos.servo_model import DatasheetRow, ProtectionLimits, ServoModel

COUNT = 2.0 * pi / 4096  # rad
MODEL_NUMBER = Register("model_number", 0, 2, "eeprom", writable=False)
FIRMWARE = Register("firmware_version", 2, 1, "eeprom", writable=False)
REGISTERS = (
    MODEL_NUMBER,
    FIRMWARE,
    Register("id", 3, 1, "eeprom"),
    Register("baud_rate", 4, 1, "eeprom"),
    Register("return_delay", 5, 1, "eeprom", unit=2e-6),
    Register("shutdown", 6, 1, "eeprom"),
    Register("position_p_gain", 20, 1),
    Register("torque_enable", 24, 1),
    Register("goal_position", 26, 2, unit=COUNT),
    Register("present_position", 30, 2, writable=False, unit=COUNT),
    Register("present_velocity", 32, 2, writable=False, signed=True, unit=0.01),
    Register("present_load", 34, 2, writable=False, signed=True, unit=1e-3),
    Register("present_voltage", 36, 1, writable=False, unit=0.1),
    Register("present_temperature", 37, 1, writable=False),
)
A1 = ServoModel(
    name="A1",
    model_number=4711,
    rows=(
        DatasheetRow.of(12.0, 2.0, 60, 1.5),
    ),  # V, N m at stall, turns a minute without load, A at stall
    error_gain=0.16,  # duty per rad of error and unit of the P register
    p_default=32,
    armature=0.01,  # rotor inertia through the gearbox, kg m2
    friction_loss=0.03,  # dry friction, N m
    limits=ProtectionLimits(70.0, 6.0, 14.0),  # where it protects itself: degrees C, V, V
)
FAMILY = plain_family(
    name="Acme",
    protocol_name="acme",
    protocol=Feetech(MODEL_NUMBER, FIRMWARE, always_sync=True),
    registers=REGISTERS,
    models=[A1],
    bauds={1_000_000: 0, 115_200: 1},
    errors={0: "input voltage", 2: "overheating", 5: "overload"},
    required=[RequiredSetting("return_delay", 0), RequiredSetting("shutdown", 0b100101)],
    emulation="acme_servos.emulation:EMULATION",
)
