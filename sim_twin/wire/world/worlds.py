"""Registry of the worlds that are open in this process, so that ports can share a world."""

from dataclasses import dataclass, replace

from windup.hal.errors import UnknownNameError, UsageError
from windup.sim_twin.wire.world.address import Address
from windup.sim_twin.wire.world.build import build_world
from windup.sim_twin.wire.world.bus_world import BusWorld
from windup.sim_twin.wire.world.clocks import RealClock, VirtualClock, WireClock


@dataclass
class Running:
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


_running: dict[str, Running] = {}


def put_world(name: str, world: BusWorld, clock: str = "virtual") -> None:
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


def drop_world(name: str) -> None:
    """Remove a world from the registry; open ports keep it until they are closed."""
    running = _running.pop(name, None)
    if running is not None and not running.ports:
        _end(running)


def enter(address: Address) -> Running:
    """Return the running world of an address, built if necessary, and count one more port."""
    name = address.world or f"{address.robot} ({address.clock})"
    running = _running.get(name) or _running.pop(_lost_name(address), None)
    if running is None:
        running = _start(build_world(address), address.clock, keep=bool(address.world))
    elif running.kind != address.clock:
        raise UsageError(
            f"world {name!r} runs on a {running.kind} clock, not a {address.clock} one"
        )
    if address.bus and address.bus not in running.world.buses:
        raise UnknownNameError("bus", address.bus, running.world.buses)
    _running[name] = running
    running.ports += 1
    return running


def leave(running: Running, lost: Address | None = None) -> None:
    """Count one port less; an unnamed world ends with its last port.

    An exception is a port that was lost by unplugging: opening its address again finds the world.
    """
    running.ports -= 1
    if running.ports == 0 and not running.keep:
        for name in [name for name, other in _running.items() if other is running]:
            del _running[name]
        if lost is not None:
            _running[_lost_name(lost)] = running
    if running.ports == 0 and not any(other is running for other in _running.values()):
        _end(running)


def _end(running: Running) -> None:
    """Clear the schedule of an unreachable world: its actions would keep the world alive."""
    running.world.schedule.clear()


def _lost_name(address: Address) -> str:
    return repr(replace(address, bus=""))


def _start(world: BusWorld, clock: str, keep: bool) -> Running:
    ticking: WireClock = VirtualClock(world) if clock == "virtual" else RealClock(world)
    return Running(world, ticking, clock, keep=keep)
