"""What happens once, between opening the ports of a robot and the first tick of its loop."""

from collections.abc import Mapping, Sequence

import numpy as np

from hal.backend import Clock
from hal.bus import Bus
from hal.clock import WallClock
from hal.errors import UsageError
from hal.imu.opencr import POWER, POWER_UP_TIME, OpenCr
from hal.joints import Array, Joints, Mask
from hal.servo_line import ServoLine
from hal.servo_model import ServoMount
from hal.servo_settings import assert_settings
from hal.wiring import check_servos


def one_clock(clocks: Sequence[Clock]) -> Clock:
    """Return the clock that all ports of a robot live on.

    Raises:
        UsageError: Some live on the wall's time and some in a virtual world, or in two worlds.
    """
    first = clocks[0]
    wall = isinstance(first, WallClock)
    for clock in clocks[1:]:
        if clock is not first and not (wall and isinstance(clock, WallClock)):
            raise UsageError("the buses of one robot have to live in one world, on one clock")
    return first


def set_up(
    joints: Joints, mounts: Sequence[ServoMount], buses: Mapping[str, Bus], board: OpenCr | None
) -> None:
    """Give the servos power, check all of them, then write the settings that differ.

    Raises:
        HardwareError: Something is not as wired; nothing has been written.
    """
    if board is not None:
        power_up(buses[board.bus], board)
    for bus, id, settings in check_servos(joints, mounts, buses, board):
        assert_settings(bus, id, settings)


def power_up(bus: Bus, board: OpenCr) -> None:
    """Give the servos power where an OpenCR switches it."""
    if bus.read(board.id, POWER) != 1:
        bus.write(board.id, POWER, 1)
        clock = bus.port.clock
        clock.wait_until(clock.now() + POWER_UP_TIME)


def read_health(line: ServoLine, health: Array) -> None:
    """Fill voltage and temperature of the joints of a line into (2, n); the cycle refreshes it."""
    for row, name in enumerate(("present_voltage", "present_temperature")):
        register = line.bus.family.registers[name]
        counts, valid = line.bus.sync_read(line.ids, register)
        health[row, line.rows[valid]] = counts[valid] * register.unit


def names_of(joints: Joints, which: Mask) -> str:
    """Return the names of some joints, with commas."""
    return ", ".join(np.array(joints.names)[which])
