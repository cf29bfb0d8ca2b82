"""Seeded, repeatable faults of status packets, servos, supply, adapter, IMU and board."""

import random
from collections import deque
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple, Self
from weakref import ReferenceType, ref

from windup.hal.errors import UsageError
from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.faults.answer_faults import PacketFaults, Sender
from windup.sim_twin.wire.faults.fault_events import (
    OF_IMU,
    SILENCING,
    WHOLE_BUS,
    FaultyWorld,
    apply_event,
    event_targets,
)
from windup.sim_twin.wire.faults.fault_methods import FaultMethods
from windup.sim_twin.wire.faults.fault_rule import EVENTS, KINDS, REQUESTS, FaultRule
from windup.sim_twin.wire.faults.fault_text import parse_rules

REMEMBERED = 10_000  # number of latest hits that are kept


class AppliedFault(NamedTuple):
    """One fault that happened: time (s), kind, bus and id (-1: the whole bus)."""

    time: float
    kind: str
    bus: str
    identifier: int


class Faults(FaultMethods):
    """The faults on the buses of a world.

    Args:
        seed: Seed of the random numbers.

    Attributes:
        active: Whether any fault is configured.
        counts: Number of times that each kind happened.
        hits: The last 10,000 faults that happened.
    """

    def __init__(self, seed: int = 0) -> None:
        self.active = False
        self.counts = dict.fromkeys(KINDS, 0)
        self.hits: deque[AppliedFault] = deque(maxlen=REMEMBERED)
        self._rules: list[FaultRule] = []
        self._dice = random.Random(seed)
        self._of: ReferenceType[FaultyWorld] | None = None
        self._sender = Sender()
        self._said: dict[tuple[str, int, int], bytes] = {}  # (bus, id, length) -> last answer

    @classmethod
    def parse(cls, text: str, seed: int = 0) -> "Faults":
        """Return the faults of a text like ``drop:0.01,reset:at=2.5:ids=7``; see `parse_rules`.

        Raises:
            UsageError: The text is malformed or a value is out of range.
        """
        faults = cls(seed)
        for rule in parse_rules(text):
            faults.add(rule)
        return faults

    def add(self, rule: FaultRule) -> Self:
        """Add a fault.

        Raises:
            UsageError: It refers to a bus, servos or an IMU that the world does not have.
        """
        self.check([rule])
        self._rules.append(rule)
        self.active = True
        self._script(rule)
        return self

    def inject(self, rules: Sequence[FaultRule], now: float) -> None:
        """Add faults whose times count from `now`, s; see `parse_rules`."""
        for rule in rules:
            self.add(replace(rule, at=[now + time for time in rule.at]))

    def clear(self) -> Self:
        """Remove all faults; devices that are broken already stay broken."""
        self._rules.clear()
        self.active = False
        return self

    def attach(self, world: FaultyWorld) -> None:
        """Connect the faults to a world and schedule its timed events.

        Raises:
            UsageError: A fault refers to a bus, servos or an IMU that the world does not have.
        """
        if self._world is None:
            self._of = ref(world)  # a weak reference: the world's buses refer to the faults
            self.check(self._rules)
            for rule in self._rules:
                self._script(rule)

    @property
    def now(self) -> float:
        """Time of the world, s; 0 before `attach`."""
        return 0.0 if self._world is None else self._world.now

    @property
    def _world(self) -> FaultyWorld | None:
        return None if self._of is None else self._of()

    def check(self, rules: Sequence[FaultRule]) -> None:
        """Check that faults can happen in the world; before `attach` all can.

        Raises:
            UsageError: A fault refers to a bus, servos or an IMU that the world does not have.
        """
        if self._world is None:
            return
        buses = self._world.buses.values()
        there = {bus.name: [device.identifier for device in bus.devices] for bus in buses}
        for rule in rules:
            rule.check_target(there)
            if rule.kind in EVENTS and not any(event_targets(rule, bus) for bus in buses):
                what = (
                    "IMU" if rule.kind in OF_IMU else "OpenCR" if rule.kind == "button" else "servo"
                )
                raise UsageError(f"faults: {rule.kind}: there is no {what} in this world")

    def noise(self, count: int) -> bytes:
        """Return random bytes, as received in a collision or at a wrong baud rate."""
        return self._dice.randbytes(count)

    def answer(self, bus: Bus, data: bytes, baud: int, identifier: int) -> float:
        """Send a status packet with the faults that hit it now; return when it ends, s."""
        key, now = (bus.name, identifier, len(data)), bus.schedule.now
        packet_faults, self._said[key] = PacketFaults(data, self._said.get(key, data)), data
        for rule in [*self._rules]:
            if rule.kind in REQUESTS:
                continue
            if not rule.hits(self._dice, bus.name, identifier, now) or not packet_faults.received:
                continue  # a packet that is lost already cannot be hit again
            if rule.kind in EVENTS:
                self._begin(rule, bus, identifier, packet_faults)
                continue
            self._note(rule.kind, bus.name, identifier)
            packet_faults.apply(rule.kind, rule.seconds, bus, self._dice)
        return self._sender.send(bus, data, baud, packet_faults)

    def echoes(self, bus: Bus) -> bool:
        """Return whether the adapter echoes the host's present bytes back to it."""
        echoes = False
        for rule in self._rules:
            now = bus.schedule.now
            if rule.kind == "echo" and rule.hits(self._dice, bus.name, WHOLE_BUS, now):
                self._note(rule.kind, bus.name, WHOLE_BUS)
                echoes = True
        return echoes

    def _begin(
        self, rule: FaultRule, bus: Bus, identifier: int, packet_faults: PacketFaults
    ) -> None:
        """Apply an event at the start of an answer, if it can hit the answering device."""
        concerned = event_targets(rule, bus)
        if WHOLE_BUS not in concerned and identifier not in concerned:
            return
        self._apply(rule, bus, identifier)
        if rule.kind in SILENCING:
            packet_faults.received = b""

    def _script(self, rule: FaultRule) -> None:
        """Schedule the timed events of a fault."""
        if self._world is not None and rule.kind in EVENTS:
            for time in rule.at:
                self._world.schedule.add(time, partial(self._apply_timed, rule))

    def _apply_timed(self, rule: FaultRule) -> None:
        """Apply a timed event unless it was cleared; remove its rule after the last time."""
        if self._world is None or not any(known is rule for known in self._rules):
            return
        self.apply_now(rule)
        if self._world.now >= rule.at[-1]:
            self._rules = [known for known in self._rules if known is not rule]
            self.active = bool(self._rules)

    def apply_now(self, rule: FaultRule) -> None:
        """Apply an event now to all its targets; before `attach` there are none."""
        for bus in self._world.buses.values() if self._world is not None else ():
            concerned = event_targets(rule, bus)
            for identifier in concerned:
                self._apply(rule, bus, identifier)
            if concerned and rule.kind == "brown_out":  # all buses share one supply
                return

    def _apply(self, rule: FaultRule, bus: Bus, identifier: int) -> None:
        """Record an event, and apply it to one device or to the bus."""
        self._note(rule.kind, bus.name, identifier)
        if self._world is not None:
            apply_event(rule, bus, identifier, self._world)

    def _note(self, kind: str, bus: str, identifier: int) -> None:
        self.counts[kind] += 1
        self.hits.append(AppliedFault(self.now, kind, bus, identifier))
