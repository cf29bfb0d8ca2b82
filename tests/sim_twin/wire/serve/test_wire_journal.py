"""What a world tells whoever dates its events; on the virtual clock, but for the dates."""

import time

from windup.sim_twin.wire import build_world, parse_address
from windup.sim_twin.wire.serve.journal import Event, WorldWatcher
from windup.sim_twin.wire.world.bus_world import BusWorld

TORQUE = 64


def bench() -> BusWorld:
    return build_world(parse_address("twin://bench?servos=XM430-W350:1-3&imu=rvc"))


def look(watcher: WorldWatcher, world: BusWorld, until: float) -> None:
    world.advance(until)
    watcher.update(world.now)


def test_a_world_in_which_nothing_happens_has_no_events() -> None:
    world, seen = bench(), list[Event]()
    watcher = WorldWatcher(world, events=seen.append)
    for step in range(10):
        look(watcher, world, 0.1 * step)
    assert seen == []


def test_driven_motors_are_counted() -> None:
    world, seen = bench(), list[Event]()
    watcher = WorldWatcher(world, events=seen.append)
    for device in world.devices[:2]:
        device.write(TORQUE, b"\x01", world.now)
        watcher.update(world.now)
    world.kill(world.devices[0])
    watcher.update(world.now)
    assert [(event.kind, event.value) for event in seen] == [
        ("driven", 1), ("driven", 2), ("driven", 1)
    ]  # fmt: skip


def test_adapters_and_supply_come_and_go_with_their_names_and_dates() -> None:
    world, seen = bench(), list[Event]()
    watcher = WorldWatcher(world, events=seen.append)
    world.faults.unplug(at=0.15, seconds=0.1, bus="imu").brown_out(at=0.35, seconds=0.1)
    before = time.monotonic()
    for step in range(6):
        look(watcher, world, 0.1 * step)
    after = time.monotonic()
    assert [event[1:] for event in seen] == [
        ("unplugged", 1, "imu"), ("plugged", 2, "imu"), ("supply", 0.0, ""), ("supply", 12.0, "")
    ]  # fmt: skip
    dates = [event.time for event in seen]
    assert dates == sorted(dates) and before <= dates[0] and dates[-1] <= after


def test_the_journal_says_at_first_how_many_are_driven_and_then_what_changes() -> None:
    world, seen = bench(), list[tuple[float, int]]()
    watcher = WorldWatcher(world, journal=lambda now, driven: seen.append((now, driven)))
    look(watcher, world, 0.1)
    world.devices[0].write(TORQUE, b"\x01", world.now)
    look(watcher, world, 0.2)
    look(watcher, world, 0.3)
    assert seen == [(0.1, 0), (0.2, 1)]
