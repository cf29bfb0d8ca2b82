"""What happens once, between opening the ports of a robot and the first tick of its loop."""

import logging
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from windup.hal.backend import Clock
from windup.hal.bus.bus import Bus
from windup.hal.bus.servo_settings import assert_settings
from windup.hal.bus.setting_words import in_words
from windup.hal.clock import WallClock
from windup.hal.errors import UsageError
from windup.hal.families import family_of
from windup.hal.imu.opencr import POWER, POWER_UP_TIME, OpenCr
from windup.hal.imu.source import ImuConnection, ImuSource
from windup.hal.joints import Joints, Mask
from windup.hal.port.lock import EMULATED, wait_while_guarded
from windup.hal.port.port import Port
from windup.hal.port.replug import Opener
from windup.hal.servo_bus.bus_connection import BusConnection, BusPort
from windup.hal.servo_bus.bus_readout import BusReadout
from windup.hal.servo_bus.plausibility import Plausibility
from windup.hal.servo_bus.units import Units
from windup.hal.servo_bus.wiring import check_servos, row_groups
from windup.hal.servos.servo_model import ServoMount

BuildLine = Callable[[Port], BusReadout]


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


def lines_of(
    joints: Joints, mounts: Sequence[ServoMount], units: Units, board: OpenCr | None
) -> dict[str, BuildLine]:
    """Return bus name to what makes its line from its port."""

    def build(name: str, rows: list[int]) -> BuildLine:
        here = [mounts[row] for row in rows]
        family = family_of(here[0].model.name)
        bounds = units.last[rows], units.speed[rows], units.speed_unit[rows]
        check = Plausibility(*bounds, weak=family.dialect.weak, first=units.first[rows])
        ours = board if board is not None and board.bus == name else None
        names = [joints.names[row] for row in rows]
        return lambda port: BusReadout(Bus(port, family), here, rows, ours, check, names)

    return {name: build(name, rows) for name, rows in row_groups(mounts).items()}


def open_links(
    lines: Mapping[str, BuildLine],
    ports: Mapping[str, BusPort],
    imu: ImuSource | None,
    watchdog: float,
    opener: Opener,
) -> tuple[list[BusConnection], ImuConnection | None, Clock]:
    """Return the open buses, the IMU's connection if it has one, and the clock they live on.

    Raises:
        PortError: One cannot be opened; the others are closed again.
        UsageError: They do not live on one clock.
    """
    links: list[BusConnection] = []
    beside: ImuConnection | None = None
    try:
        for name, build in lines.items():
            wait_while_guarded(ports[name].url)
            links.append(BusConnection(ports[name], opener, build, watchdog))
        if imu is not None:
            beside = imu.connect(opener)
        clocks = [link.clock for link in (*links, beside) if link is not None]
        return links, beside, one_clock(clocks)
    except BaseException:
        for link in (*links, beside):
            if link is not None:
                link.close()
        raise


def set_up(
    joints: Joints, mounts: Sequence[ServoMount], buses: Mapping[str, Bus], board: OpenCr | None
) -> None:
    """Measure the adapters, give the servos power, check all, then say and write what differs.

    Emulated servos forget their settings with the program: there they are not worth a word.

    Raises:
        HardwareError: Something is not as wired; nothing has been written, but the status return
            level of servos that did not answer.
    """
    for name, bus in buses.items():
        ours = [board.id] if board is not None and board.bus == name else []
        bus.get_to_know_adapter([*ours, *(mount.id for mount in mounts if mount.bus == name)])
    if board is not None:
        power_up(buses[board.bus], board)
    found = check_servos(joints, mounts, buses, board)
    real = [differs for differs in found if not differs.bus.port.url.startswith(EMULATED)]
    for line in in_words(real):
        logging.getLogger(__name__).warning("%s", line)
    for differs in found:
        assert_settings(differs.bus, differs.id, differs.settings)


def power_up(bus: Bus, board: OpenCr) -> None:
    """Give the servos power where an OpenCR switches it."""
    if bus.read(board.id, POWER) != 1:
        bus.write(board.id, POWER, 1)
        bus.wait(POWER_UP_TIME)


def names_of(joints: Joints, which: Mask) -> str:
    """Return the names of some joints, with commas."""
    return ", ".join(np.array(joints.names)[which])
