"""Builds the guardian's records of the robot's buses that another process can open."""

import numpy as np

from windup.hal.errors import UsageError
from windup.hal.guard.levels import HealthKind, HealthLevels
from windup.hal.guardian.order import GuardedBus
from windup.hal.joints import Array
from windup.hal.port.network_port import NETWORK
from windup.hal.port.open_port import stable_url
from windup.hal.port.port import DevicePort
from windup.hal.servo_bus.bus_connection import BusConnection
from windup.hal.servo_bus.servo_backend import ServoBackend


def guarded_buses(
    backend: ServoBackend, crouch: Array | None, levels: HealthLevels | None
) -> list[GuardedBus]:
    """Return the guardian's records of the buses that are not emulated in this process.

    Args:
        backend: The backend, whose ports are open.
        crouch: (n,) pose of the robot's crouch, rad.
        levels: Health levels of the robot's joints.

    Raises:
        UsageError: Servos without a bus watchdog are reached through a network.
    """
    links = [link for link in backend.links if _outside(link)]
    for link in links:
        _check_network(link)
    goals = None if crouch is None else backend.goal_counts(crouch)
    return [guarded_bus(link, goals, levels) for link in links]


def guarded_bus(
    link: BusConnection, goals: Array | None, levels: HealthLevels | None
) -> GuardedBus:
    """Return the guardian's record of a bus; `goals` (n,) are those of the crouch, counts."""
    port, readout = link.bus.port, link.readout
    counts = (
        {} if goals is None else dict(zip(readout.ids, goals[readout.rows].tolist(), strict=True))
    )
    hot_and_low = {}
    if levels is not None:
        stop = levels.stop[[HealthKind.TEMPERATURE, HealthKind.SUPPLY_LOW]][:, readout.rows]
        hot_and_low = {
            id: (float(hot), float(low)) for id, hot, low in zip(readout.ids, *stop, strict=True)
        }
    return GuardedBus(
        url=stable_url(port.absolute_url),
        baud=port.baud,
        servos={mount.id: mount.model.name for mount in readout.mounts},
        crouch={id: int(np.rint(count)) for id, count in counts.items()},
        levels=hot_and_low,
        names=dict(zip(readout.ids, readout.names, strict=False)),  # joint names, if known
        extended=tuple(mount.id for mount in readout.mounts if mount.extended),
        latency=port.latency,
        echoes=port.echoes,
    )


def _outside(link: BusConnection) -> bool:
    """Return whether another process can open the port of a bus."""
    port = link.bus.port
    return isinstance(port, DevicePort) or port.url.startswith(NETWORK)


def _check_network(link: BusConnection) -> None:
    """Refuse a network port if nothing could stop the servos after a network failure.

    Raises:
        UsageError: The servos have no bus watchdog.
    """
    url, registers = link.bus.port.url, link.bus.family.registers
    if url.startswith(NETWORK) and "bus_watchdog" not in registers:
        raise UsageError(
            f"{url}: these servos have no bus watchdog, so they would not stop if the "
            "network failed; run Windup on the machine that the adapter is plugged into"
        )
