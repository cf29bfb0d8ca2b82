"""Fault events of servos, supply, adapter, IMU and board: their targets and their effects."""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Final, Protocol

from windup.sim_twin.wire.boards.opencr import USER_BUTTON, OpenCr
from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.faults.fault_rule import FaultRule
from windup.sim_twin.wire.schedule import Schedule

WHOLE_BUS = -1
OF_BUS: Final = frozenset(("unplug", "brown_out"))
OF_IMU: Final = frozenset(("imu_silent", "imu_frozen", "imu_spin"))
SILENCING: Final = frozenset(("dead", "reset", "brown_out", "unplug", "imu_silent"))
"""Events that also suppress the status packet at whose start they happen."""


class FaultyWorld(Protocol):
    """The part of the world that faults act on: its buses, its time and its supply."""

    @property
    def buses(self) -> Mapping[str, Bus]:
        """The buses by name."""
        ...

    @property
    def schedule(self) -> Schedule:
        """The schedule of future actions."""
        ...

    @property
    def now(self) -> float:
        """Time, s."""
        ...

    def sag(self, volts: float) -> None:
        """Lower the supply to a voltage, V."""
        ...

    def recover(self, volts: float) -> None:
        """End the sag to that voltage, V."""
        ...

    def kill(self, device: Device) -> None:
        """Break a device permanently."""
        ...


def event_targets(rule: FaultRule, bus: Bus) -> Sequence[int]:
    """Return the ids on a bus that an event hits; `WHOLE_BUS` stands for the bus itself."""
    if rule.bus not in (None, bus.name):
        return []
    if rule.kind in OF_BUS:
        return [WHOLE_BUS]
    if rule.kind in OF_IMU and bus.imu is None:
        return []
    boards = rule.kind in OF_IMU or rule.kind == "button"
    if rule.kind in OF_IMU and not bus.devices:  # an IMU that streams by itself has no id
        return [WHOLE_BUS] if rule.ids is None else []
    ids = [d.identifier for d in bus.devices if not boards or isinstance(d, OpenCr)]
    return [id for id in ids if rule.applies_to(bus.name, id)]


def apply_event(rule: FaultRule, bus: Bus, identifier: int, world: FaultyWorld) -> None:
    """Apply an event to one device of a bus, or to the whole bus."""
    if rule.kind == "unplug":
        bus.unplug(rule.seconds)
    elif rule.kind == "brown_out":
        world.sag(rule.volts)
        _end(bus, rule, partial(world.recover, rule.volts))
    elif rule.kind in OF_IMU:
        _fail(rule, bus)
    else:
        for device in [*bus.devices]:
            if device.identifier == identifier:
                _hit(rule, bus, device, world)


def _hit(rule: FaultRule, bus: Bus, device: Device, world: FaultyWorld) -> None:
    """Apply an event to one device."""
    now = bus.schedule.now
    if rule.kind == "reset":
        device.reboot(now)
        bus.refresh()
    elif rule.kind == "overload":
        device.overload(now)
    elif rule.kind == "dead":
        world.kill(device)
    elif rule.kind == "heat":
        device.heat(rule.degrees)
        _end(bus, rule, partial(device.heat, -math.inf))
    elif isinstance(device, OpenCr):
        device.press(USER_BUTTON)
        _end(bus, rule, partial(device.release, USER_BUTTON))


def _fail(rule: FaultRule, bus: Bus) -> None:
    """Make the IMU of a bus fail."""
    imu = bus.imu
    assert imu is not None
    if rule.kind == "imu_silent":
        imu.fall_silent(rule.seconds)
    elif rule.kind == "imu_frozen":
        imu.freeze(rule.seconds)
    else:
        imu.spin(rule.seconds, rule.speed)


def _end(bus: Bus, rule: FaultRule, undo: Callable[[], None]) -> None:
    """Schedule `undo` for the end of an event, unless it lasts for ever."""
    if rule.seconds < math.inf:
        bus.schedule.add(bus.schedule.now + rule.seconds, undo)
