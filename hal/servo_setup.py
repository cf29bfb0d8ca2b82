"""What happens once, between opening the ports of a robot and the first tick of its loop."""

import logging
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from hal.backend import Clock
from hal.bus import Bus
from hal.clock import WallClock
from hal.errors import UsageError
from hal.families import family_of
from hal.guardian.lock import wait_while_guarded
from hal.imu.opencr import POWER, POWER_UP_TIME, OpenCr
from hal.imu.source import ImuSource
from hal.imu_link import ImuLink
from hal.joints import Joints, Mask
from hal.plausibility import Plausibility
from hal.port import Port
from hal.replug import Opener
from hal.servo_line import ServoLine
from hal.servo_link import BusPort, ServoLink
from hal.servo_model import ServoMount
from hal.servo_settings import assert_settings
from hal.units import Units
from hal.wiring import Differences, check_servos, row_groups

BuildLine = Callable[[Port], ServoLine]
MANY = 4
"""More joints than these are counted, not named."""


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
        check = Plausibility(*bounds, weak=family.dialect.weak)
        ours = board if board is not None and board.bus == name else None
        names = [joints.names[row] for row in rows]
        return lambda port: ServoLine(Bus(port, family), here, rows, ours, check, names)

    return {name: build(name, rows) for name, rows in row_groups(mounts).items()}


def open_links(
    lines: Mapping[str, BuildLine],
    ports: Mapping[str, BusPort],
    imu: ImuSource | None,
    watchdog: float,
    opener: Opener,
) -> tuple[list[ServoLink], ImuLink | None, Clock]:
    """Return the open buses, the IMU's port if it has one, and the clock they live on.

    Raises:
        PortError: One cannot be opened; the others are closed again.
        UsageError: They do not live on one clock.
    """
    links: list[ServoLink] = []
    beside: ImuLink | None = None
    try:
        for name, build in lines.items():
            wait_while_guarded(ports[name].url)
            links.append(ServoLink(ports[name], opener, build, watchdog))
        if imu is not None:
            beside = ImuLink(imu, opener)
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
    """Give the servos power, check all of them, then write the settings that differ.

    Raises:
        HardwareError: Something is not as wired; nothing has been written.
    """
    if board is not None:
        power_up(buses[board.bus], board)
    found = check_servos(joints, mounts, buses, board)
    if said := settings_said(found):
        logging.getLogger(__name__).warning("%s", said)
    for differs in found:
        assert_settings(differs.bus, differs.id, differs.settings)


def settings_said(found: Differences) -> str:
    """Return in one line what is changed in the EEPROM of which joints; "" for nothing.

    What a servo forgets without power is set at every start, and not worth a word.
    """
    joints: dict[str, list[str]] = {}
    for differs in found:
        changes = [
            f"{setting.register.name} {setting.present} -> {setting.wanted}"
            for setting in differs.settings
            if setting.register.area == "eeprom"
        ]
        for change in filter(None, [differs.repaired, *changes]):
            joints.setdefault(change, []).append(differs.joint)
    said = [f"{change} at {_some(names, len(found))}" for change, names in joints.items()]
    return f"servo settings are changed: {'; '.join(said)}" if said else ""


def _some(names: Sequence[str], all_: int) -> str:
    """Return the names of some joints, or how many, where a list would be long."""
    if len(names) == all_ > 1:
        return f"all {all_} joints"
    return ", ".join(names) if len(names) <= MANY else f"{len(names)} joints"


def power_up(bus: Bus, board: OpenCr) -> None:
    """Give the servos power where an OpenCR switches it."""
    if bus.read(board.id, POWER) != 1:
        bus.write(board.id, POWER, 1)
        bus.wait(POWER_UP_TIME)


def names_of(joints: Joints, which: Mask) -> str:
    """Return the names of some joints, with commas."""
    return ", ".join(np.array(joints.names)[which])
