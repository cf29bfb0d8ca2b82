"""Serves a world in real time to other programs or processes.

The loop sleeps until an action is due and computes replies ahead of their time, so that bytes leave
when the modelled wire would have carried them. Each world needs a process of its own.
"""

import contextlib
import ctypes
import gc
import math
import os
import select
import time as wall
from collections.abc import Callable
from functools import partial
from pathlib import Path
from queue import SimpleQueue

from windup.hal.errors import UsageError
from windup.hal.port.port import SELECTABLE
from windup.sim_twin.wire.faults.fault_rule import FaultRule
from windup.sim_twin.wire.faults.fault_text import parse_rules
from windup.sim_twin.wire.serve.journal import Event, Journal, WorldWatcher
from windup.sim_twin.wire.serve.link import Link, Pty, Tcp, free_port
from windup.sim_twin.wire.serve.outlet import BusOutlet
from windup.sim_twin.wire.world.address import Address
from windup.sim_twin.wire.world.build import build_world
from windup.sim_twin.wire.world.bus_world import BusWorld

CHUNK = 4096
AHEAD = 0.002  # longest time by which replies may be computed ahead, s
MARGIN = 0.0005  # shortest time by which the next reply must be computed ahead, s
QUIET = 0.00015  # a step of the physics waits while bytes are due sooner than this, s
SPIN = 0.00008  # time before the ends of an answer that is polled, not slept, s
HOP = 0.000025  # latency of a pseudo-terminal each way, which the wire does not have, s
SLIP = 0.1  # lag behind the wall clock above which simulated time is delayed instead, s
IDLE = 0.002  # longest sleep, s
WARM_UP = 0.02  # time for which it serves before it says so: the first passes are slow, s
PR_SET_TIMERSLACK = 29
PRIORITY = 10  # real-time priority, so that other programs do not delay the servos


class Emulator:
    """Runs a world by the wall clock and connects its buses to other programs.

    Args:
        world: The world.
        journal: Called with the time and the number of driven motors whenever that changes.
        events: Called with every `Event`: driven motors, adapters, supply.

    Attributes:
        outlets: The buses with their links.
    """

    def __init__(
        self,
        world: BusWorld,
        journal: Journal | None = None,
        events: Callable[[Event], None] | None = None,
    ) -> None:
        self.world = world
        self.outlets: list[BusOutlet] = []
        self._wake_read, self._wake_write = os.pipe()
        self._running = True
        self._watcher = WorldWatcher(world, journal, events)
        self._orders: SimpleQueue[Callable[[], object]] = SimpleQueue()

    def connect(self, bus: str, make: Callable[[], Link]) -> None:
        """Connect a bus to the link that `make` makes, now and after each unplugging."""
        self.outlets.append(BusOutlet(self.world.bus(bus), make))
        self.outlets[-1].update_link()

    def stop(self) -> None:
        """End `run`; signal handlers and threads may call this."""
        self._running = False
        os.write(self._wake_write, b"x")

    def inject(self, text: str) -> None:
        """Apply faults while `run` serves; any thread may call this.

        An event without a rate and a time (``unplug:seconds=1``) happens now, times count from now,
        and all other faults are active from now on.

        Raises:
            UsageError: The text is wrong or cannot happen in this world, or the emulator has ended.
        """
        if not self._running:
            raise UsageError("the emulator has ended; faults cannot be injected")
        rules = parse_rules(text, live=True)
        self.world.faults.check(rules)
        self._queue_call(partial(self._begin, rules))

    def clear_faults(self) -> None:
        """Remove all faults, from any thread; devices that are broken already stay broken."""
        self._queue_call(self.world.faults.clear)

    def run(self) -> None:
        """Serve until `stop`."""
        _set_real_time()
        start = wall.perf_counter() - self.world.now
        schedule = self.world.schedule
        while self._running:
            now = wall.perf_counter() - start
            if schedule.next <= now + AHEAD:
                schedule.run_next()
                schedule.now = now
            more = schedule.next <= now + AHEAD
            due = self._send(now, more)
            if more:
                continue
            if self._step(now, due):
                self._wait(0.0, start)
                start += self._delay(now)
                continue
            step = self.world.physics_time + self.world.physics.timestep
            wake = min(due, schedule.next - MARGIN, max(step, now + QUIET), now + IDLE)
            left = wake - now
            self._wait(max(left - SPIN if wake == due else left, 0.0), start)

    def close(self) -> None:
        """Close all links."""
        for outlet in self.outlets:
            if outlet.link is not None:
                outlet.link.close()
        os.close(self._wake_read)
        os.close(self._wake_write)

    def _send(self, now: float, more: bool) -> float:
        """Send the bytes that are due; return when the next ones are, s."""
        soonest = math.inf
        now += HOP
        self.world.schedule.now = now
        for outlet in self.outlets:
            due = outlet.due(more)
            if due <= now:
                outlet.send(now)
                due = outlet.due(more)
            soonest = min(soonest, due - HOP)
        self.world.schedule.now = now - HOP
        return soonest

    def _step(self, now: float, due: float) -> bool:
        """Run a step of the physics if one is due and there is time; return whether it did."""
        world = self.world
        late = now - world.physics_time - world.physics.timestep
        if late < 0.0 or (due - now < QUIET and late < 2.0 * world.physics.timestep):
            return False
        world.step()
        for outlet in self.outlets:
            if outlet.bus.plugged is (outlet.link is None):
                outlet.update_link()
        self._watcher.update(now)
        return True

    def _delay(self, now: float) -> float:
        """Return the time by which simulated time must be delayed, s; a large lag is not caught up.

        Catching up would leave no time to receive, and the servos would run too fast.
        """
        late = now - self.world.physics_time
        return 0.0 if late < SLIP else late

    def _wait(self, seconds: float, start: float) -> None:
        """Wait for bytes from a program for up to `seconds`, then receive them."""
        places = {place: outlet for outlet in self.outlets for place in outlet.descriptors()}
        ready = _readable([*places, self._wake_read], seconds)
        self.world.schedule.now = wall.perf_counter() - start - HOP
        for place in ready:
            if place in places:
                places[place].receive()
            else:
                self._run_queued()
        for outlet in self.outlets:
            outlet.feed()

    def _queue_call(self, what: Callable[[], object]) -> None:
        """Queue a call for the thread that runs `run`, and wake it."""
        self._orders.put(what)
        os.write(self._wake_write, b"i")

    def _run_queued(self) -> None:
        """Run what other threads have queued."""
        os.read(self._wake_read, CHUNK)
        while not self._orders.empty():
            self._orders.get()()

    def _begin(self, rules: list[FaultRule]) -> None:
        """Add injected faults, whose times count from now."""
        self.world.faults.inject(rules, self.world.now)


def emulate(
    address: Address,
    pty: Path | None = None,
    tcp: int | None = None,
    on_ready: Callable[[Emulator], None] | None = None,
    journal: Journal | None = None,
    events: Callable[[Event], None] | None = None,
) -> None:
    """Serve the world of an address, with one link for each bus, until `Emulator.stop`.

    An IMU on I2C has no plug: other programs open only I2C buses of the kernel.

    Args:
        address: Address of the world.
        pty: Path of the pseudo-terminal; with several buses, the bus name is appended to it.
        tcp: TCP port of the first bus; the next bus has the next port. 0: any free port.
        on_ready: Called once it serves, `WARM_UP` after the start; `Emulator.outlets` have the
            names of the links.
        journal: See `Emulator`.
        events: See `Emulator`.
    """
    if (pty is None) == (tcp is None):
        raise UsageError("give either --pty PATH or --tcp PORT")
    emulator = Emulator(build_world(address), journal, events)
    with contextlib.closing(emulator):
        serial = [name for name, bus in emulator.world.buses.items() if bus.chip is None]
        for k, bus in enumerate(serial):
            if pty is not None:
                alone = len(serial) == 1
                emulator.connect(bus, partial(Pty, pty if alone else Path(f"{pty}-{bus}")))
            elif tcp is not None:
                emulator.connect(bus, partial(Tcp, tcp + k if tcp else free_port()))
        if on_ready is not None:
            schedule = emulator.world.schedule
            schedule.add(schedule.now + WARM_UP, partial(on_ready, emulator))
        emulator.run()


def _readable(places: list[int], seconds: float) -> list[int]:
    """Wait for up to `seconds`; return the descriptors that can be read."""
    if max(places) < SELECTABLE:
        return select.select(places, [], [], seconds)[0]
    poller = select.poll()  # rounds the wait up to whole milliseconds
    for place in places:
        poller.register(place, select.POLLIN)
    return [place for place, _ in poller.poll(seconds * 1e3)]


def _set_real_time() -> None:
    """Ask the kernel for exact sleeps and real-time priority, and disable garbage collection."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(PR_SET_TIMERSLACK, 1)
    with contextlib.suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(PRIORITY))
    gc.collect()
    gc.freeze()
    gc.disable()
