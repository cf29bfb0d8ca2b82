"""Protection of an X-series servo: supply voltage, heat, overload, and injected faults.

No manual states how hot a servo gets and how long an overload may last. The constants here are
assumptions of the right order: a stalled XM430 overheats within about a minute.
"""

import math
from dataclasses import dataclass, field

from windup.sim_twin.wire.servos.control_loop import ControlLoop

INPUT_VOLTAGE, OVERHEATING, ENCODER, ELECTRICAL, OVERLOAD = 0x01, 0x04, 0x08, 0x10, 0x20

AMBIENT = 25.0  # degrees C
HEAT_CAPACITY = 20.0  # J/K
HEAT_RESISTANCE = 5.0  # K/W
OVERLOAD_LEVEL = 0.8  # share of the stall torque at the present supply
OVERLOAD_TIME = 1.0  # s


def motor_temperature(temperature: float, current: float, resistance: float, dt: float) -> float:
    """Return the temperature of a motor after `dt` s at a current in A, degrees C."""
    heat = current * current * resistance - (temperature - AMBIENT) / HEAT_RESISTANCE
    return temperature + dt * heat / HEAT_CAPACITY


@dataclass
class Health:
    """Monitors one servo.

    Attributes:
        loop: The servo's control loop: supply, torque, limits.
        temperature: Temperature of the motor, degrees C.
        errors: Bits of the Hardware Error Status; they stay until a reboot.
        minimum_temperature: Lowest temperature of the motor, set by a heat fault, degrees C.
    """

    loop: ControlLoop
    temperature: float = AMBIENT
    errors: int = 0
    minimum_temperature: float = -math.inf
    _overloaded: float = field(default=0.0, repr=False)

    def reset(self) -> None:
        """Clear the errors, as a reboot does; the temperature stays."""
        self.errors = 0
        self._overloaded = 0.0

    def inject(self, errors: int) -> None:
        """Set error bits, as a broken encoder or an electrical shock would."""
        self.errors |= errors

    def heat(self, degrees: float) -> None:
        """Keep the motor at least this hot, degrees C, from now on; -inf lets it cool again."""
        self.minimum_temperature = degrees
        self.temperature = max(self.temperature, degrees)

    def watch(self, dt: float, torque: float, driving: bool) -> None:
        """Update temperature and errors after `dt` s; `torque` is the motor's, N m."""
        loop = self.loop
        get = loop.registers.get
        torque = abs(torque) if driving else 0.0
        current = torque / loop.constant
        warm = motor_temperature(self.temperature, current, loop.resistance, dt)
        self.temperature = max(warm, self.minimum_temperature)
        stall = loop.constant / loop.resistance * loop.supply
        strained = driving and torque >= OVERLOAD_LEVEL * stall
        self._overloaded = self._overloaded + dt if strained else 0.0
        if self._overloaded > OVERLOAD_TIME:
            self.errors |= OVERLOAD
        if self.temperature >= get("temperature_limit"):
            self.errors |= OVERHEATING
        tenths = round(loop.supply * 10.0)
        if not get("min_voltage_limit") <= tenths <= get("max_voltage_limit"):
            self.errors |= INPUT_VOLTAGE
