"""Setup of the servo buses: opening ports, measuring adapters, checking and writing settings."""

import logging
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from windup.hal.backend import Clock
from windup.hal.bus.bus import Bus
from windup.hal.bus.servo_settings import assert_settings
from windup.hal.bus.setting_text import format_settings
from windup.hal.clock import WallClock
from windup.hal.errors import UsageError
from windup.hal.families import family_of
from windup.hal.imu.opencr import POWER, POWER_UP_TIME, OpenCr
from windup.hal.imu.source import ImuConnection, ImuSource
from windup.hal.joints import Joints, Mask
from windup.hal.port.lock import EMULATED, wait_while_guarded
from windup.hal.port.port import Port
from windup.hal.port.port_reopener import Opener
from windup.hal.servo_bus.bus_connection import BusConnection, BusPort
from windup.hal.servo_bus.bus_readout import BusReadout
from windup.hal.servo_bus.joint_readings import JointReadings
from windup.hal.servo_bus.plausibility import Plausibility
from windup.hal.servo_bus.units import Units
from windup.hal.servo_bus.wiring import check_servos, row_groups
from windup.hal.servos.servo_model import ServoMount

ATTEMPTS = 30
"""Maximum number of cyclic reads until every joint has answered."""
BuildReadout = Callable[[Port], BusReadout]


def common_clock(clocks: Sequence[Clock]) -> Clock:
    """Return the clock that all ports of a robot share.

    Raises:
        UsageError: Some use the wall clock and some a virtual clock, or two virtual clocks.
    """
    first = clocks[0]
    wall = isinstance(first, WallClock)
    for clock in clocks[1:]:
        if clock is not first and not (wall and isinstance(clock, WallClock)):
            raise UsageError(
                "the buses of one robot must share one clock: one twin:// world, or real ports only"
            )
    return first


def build_readouts(
    joints: Joints, mounts: Sequence[ServoMount], units: Units, board: OpenCr | None
) -> dict[str, BuildReadout]:
    """Return, by bus name, a function that builds the readout of the bus from its port."""

    def build(name: str, rows: list[int]) -> BuildReadout:
        here = [mounts[row] for row in rows]
        family = family_of(here[0].model.name)
        bounds = units.last[rows], units.speed[rows], units.speed_unit[rows]
        check = Plausibility(*bounds, weak=family.protocol.weak, first=units.first[rows])
        ours = board if board is not None and board.bus == name else None
        names = [joints.names[row] for row in rows]
        return lambda port: BusReadout(Bus(port, family), here, rows, ours, check, names)

    return {name: build(name, rows) for name, rows in row_groups(mounts).items()}


def open_links(
    readouts: Mapping[str, BuildReadout],
    ports: Mapping[str, BusPort],
    imu: ImuSource | None,
    watchdog: float,
    opener: Opener,
) -> tuple[list[BusConnection], ImuConnection | None, Clock]:
    """Open all ports; return the buses, the connection of an IMU that has one, and their clock.

    Raises:
        PortError: A port cannot be opened; the others are closed again.
        UsageError: The ports do not share one clock.
    """
    links: list[BusConnection] = []
    beside: ImuConnection | None = None
    try:
        for name, build in readouts.items():
            wait_while_guarded(ports[name].url)
            links.append(BusConnection(ports[name], opener, build, watchdog))
        if imu is not None:
            beside = imu.connect(opener)
        clocks = [link.clock for link in (*links, beside) if link is not None]
        return links, beside, common_clock(clocks)
    except BaseException:
        for link in (*links, beside):
            if link is not None:
                link.close()
        raise


def set_up_servos(
    joints: Joints, mounts: Sequence[ServoMount], buses: Mapping[str, Bus], board: OpenCr | None
) -> None:
    """Measure the adapters, switch servo power on, check all servos, log and write what differs.

    Changes of emulated servos are not logged: they are lost when the program ends.

    Raises:
        HardwareError: The wiring differs from robot.toml; nothing has been written except the
            status return level of servos that did not answer.
    """
    for name, bus in buses.items():
        ours = [board.id] if board is not None and board.bus == name else []
        bus.measure_adapter([*ours, *(mount.id for mount in mounts if mount.bus == name)])
    if board is not None:
        switch_servo_power_on(buses[board.bus], board)
    found = check_servos(joints, mounts, buses, board)
    real = [servo for servo in found if not servo.bus.port.url.startswith(EMULATED)]
    for line in format_settings(real):
        logging.getLogger(__name__).warning("%s", line)
    for servo in found:
        assert_settings(servo.bus, servo.id, servo.settings)


def switch_servo_power_on(bus: Bus, board: OpenCr) -> None:
    """Switch on the servo power of an OpenCR, and wait until the servos have started."""
    if bus.read(board.id, POWER) != 1:
        bus.write(board.id, POWER, 1)
        bus.wait(POWER_UP_TIME)


def names_of(joints: Joints, which: Mask) -> str:
    """Return the names of the joints `which` (n,) bool, separated by commas."""
    return ", ".join(np.array(joints.names)[which])


def silent_joints(
    joints: Joints, readings: JointReadings, read: Callable[[], object], began: float
) -> str:
    """Read until every joint has answered since `began` s, `ATTEMPTS` times at most.

    Returns:
        Names of the joints that have not answered, separated by commas.
    """
    for _ in range(ATTEMPTS):
        read()
        if (readings.answered > began).all():
            break
    return names_of(joints, readings.answered <= began)
