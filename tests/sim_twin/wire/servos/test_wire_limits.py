import pytest

from windup.hal.families import servo_model, servo_names
from windup.hal.servos.servo_model import ProtectionLimits
from windup.sim_twin.wire.servos import dynamixel1_tables, feetech_tables, x_series


def factory_limits(name: str) -> ProtectionLimits:
    """Return what the limit registers of an emulated servo hold when it is new."""
    if name in x_series.MODELS:
        get = x_series.MODELS[name].registers().get
    elif name in feetech_tables.MODELS:
        get = feetech_tables.MODELS[name].table().get
    else:
        get = dynamixel1_tables.MODELS[name].table().get
    plain = name in feetech_tables.MODELS
    heat = "max_temperature" if plain else "temperature_limit"
    low, high = ("min_voltage", "max_voltage") if plain else ("min_voltage_limit",
                                                              "max_voltage_limit")  # fmt: skip
    return ProtectionLimits(float(get(heat)), get(low) / 10.0, get(high) / 10.0)


@pytest.mark.parametrize("name", servo_names())
def test_the_limits_of_a_servo_are_those_in_its_registers(name: str) -> None:
    assert servo_model(name).limits == factory_limits(name)
