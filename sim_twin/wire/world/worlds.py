"""Registry of the worlds that are open in this process, so that ports can share a world."""

from dataclasses import dataclass, replace

from windup.hal.errors import UnknownNameError, UsageError
from windup.sim_twin.wire.world.address import Address
from windup.sim_twin.wire.world.build import build_world
from windup.sim_twin.wire.world.bus_world import BusWorld
from windup.sim_twin.wire.world.clocks import RealClock, VirtualClock, WireClock


@dataclass
class OpenWorld:
    """An open world.

    Attributes:
        world: The world.
        clock: Its clock.
        kind: "virtual" or "real".
        ports: Number of open ports.
        keep: Whether it stays when the last port is closed.
    """

    world: BusWorld
    clock: WireClock
    kind: str
    ports: int = 0
    keep: bool = False


_running: dict[str, OpenWorld] = {}


def register_world(name: str, world: BusWorld, clock: str = "virtual") -> None:
    """Register a world under ``twin://anything?world=NAME``; it stays until `drop_world`."""
    _running[name] = _start(world, clock, keep=True)


def find_world(name: str) -> BusWorld:
    """Return the world of this name.

    Raises:
        UnknownNameError: There is no such world.
    """
    if name not in _running:
        raise UnknownNameError("world", name, _running)
    return _running[name].world


def unregister_world(name: str) -> None:
    """Remove a world from the registry; open ports keep it until they are closed."""
    entry = _running.pop(name, None)
    if entry is not None and not entry.ports:
        _end(entry)


def open_world(address: Address) -> OpenWorld:
    """Return the running world of an address, built if necessary, and count one more port."""
    name = address.world or f"{address.robot} ({address.clock})"
    entry = _running.get(name) or _running.pop(_lost_name(address), None)
    if entry is None:
        entry = _start(build_world(address), address.clock, keep=bool(address.world))
    elif entry.kind != address.clock:
        raise UsageError(f"world {name!r} runs on a {entry.kind} clock, not a {address.clock} one")
    if address.bus and address.bus not in entry.world.buses:
        raise UnknownNameError("bus", address.bus, entry.world.buses)
    _running[name] = entry
    entry.ports += 1
    return entry


def release_world(entry: OpenWorld, lost: Address | None = None) -> None:
    """Count one port less; an unnamed world ends with its last port.

    An exception is a port that was lost by unplugging: opening its address again finds the world.
    """
    entry.ports -= 1
    if entry.ports == 0 and not entry.keep:
        for name in [name for name, other in _running.items() if other is entry]:
            del _running[name]
        if lost is not None:
            _running[_lost_name(lost)] = entry
    if entry.ports == 0 and not any(other is entry for other in _running.values()):
        _end(entry)


def _end(entry: OpenWorld) -> None:
    """Clear the schedule of an unreachable world: its actions would keep the world alive."""
    entry.world.schedule.clear()


def _lost_name(address: Address) -> str:
    return repr(replace(address, bus=""))


def _start(world: BusWorld, clock: str, keep: bool) -> OpenWorld:
    ticking: WireClock = VirtualClock(world) if clock == "virtual" else RealClock(world)
    return OpenWorld(world, ticking, clock, keep=keep)
