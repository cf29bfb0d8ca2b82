"""Faults of answers, servos, supply and adapter, seeded, so that a run can be had again."""

import random
from collections import deque
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple, Self
from weakref import ReferenceType, ref

from windup.hal.errors import UsageError
from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.faults.answer_faults import Fate, Sender
from windup.sim_twin.wire.faults.fault_events import (
    EVERYBODY,
    OF_IMU,
    SILENCING,
    Circuit,
    befall,
    victims,
)
from windup.sim_twin.wire.faults.fault_methods import FaultMethods
from windup.sim_twin.wire.faults.fault_rule import EVENTS, KINDS, REQUESTS, Rule
from windup.sim_twin.wire.faults.fault_text import parse_rules

REMEMBERED = 10_000  # hits


class Hit(NamedTuple):
    """One fault that happened: when (s), what, on which bus, to which id (-1: everybody)."""

    time: float
    kind: str
    bus: str
    identifier: int


class Faults(FaultMethods):
    """What goes wrong on the buses of a world.

    Args:
        seed: Seed of the dice.

    Attributes:
        active: Whether there is anything to go wrong.
        counts: Kind to the number of times it happened.
        hits: What happened, the last 10,000 of it.
    """

    def __init__(self, seed: int = 0) -> None:
        self.active = False
        self.counts = dict.fromkeys(KINDS, 0)
        self.hits: deque[Hit] = deque(maxlen=REMEMBERED)
        self._rules: list[Rule] = []
        self._dice = random.Random(seed)
        self._of: ReferenceType[Circuit] | None = None
        self._sender = Sender()
        self._said: dict[tuple[str, int, int], bytes] = {}  # bus, id, length to the last answer

    @classmethod
    def parse(cls, text: str, seed: int = 0) -> "Faults":
        """Return the faults of a text like ``drop:0.01,reset:at=2.5:ids=7``; see `parse_rules`.

        Raises:
            UsageError: The text says something else.
        """
        faults = cls(seed)
        for rule in parse_rules(text):
            faults.add(rule)
        return faults

    def add(self, rule: Rule) -> Self:
        """Add a fault."""
        self._rules.append(rule)
        self.active = True
        self._script(rule)
        return self

    def inject(self, rules: Sequence[Rule], now: float) -> None:
        """Add faults whose times count from `now` s; see `parse_rules`."""
        for rule in rules:
            self.add(replace(rule, at=[now + time for time in rule.at]))

    def clear(self) -> Self:
        """Let nothing go wrong any more; what is broken stays broken."""
        self._rules.clear()
        self.active = False
        return self

    def attach(self, world: Circuit) -> None:
        """Take the world into which scripted faults go.

        Raises:
            UsageError: A fault concerns a bus, servos or an IMU that are not in it.
        """
        if self._world is None:
            self._of = ref(world)  # the world has the buses, and they have us
            self.check(self._rules)
            for rule in self._rules:
                self._script(rule)

    @property
    def now(self) -> float:
        """Time of the world, s; 0 before `attach`."""
        return 0.0 if self._world is None else self._world.now

    @property
    def _world(self) -> Circuit | None:
        return None if self._of is None else self._of()

    def check(self, rules: Sequence[Rule]) -> None:
        """Raise what could never happen in the world.

        Raises:
            UsageError: A fault concerns a bus, servos or an IMU that are not in it.
        """
        buses = self._world.buses.values() if self._world is not None else ()
        there = {bus.name: [device.identifier for device in bus.devices] for bus in buses}
        for rule in rules:
            rule.check_target(there)
            if rule.kind in EVENTS and not any(victims(rule, bus) for bus in buses):
                what = (
                    "IMU" if rule.kind in OF_IMU else "OpenCR" if rule.kind == "button" else "servo"
                )
                raise UsageError(f"faults: {rule.kind}: there is no {what} that it could hit")

    def noise(self, count: int) -> bytes:
        """Return bytes as of a collision or a wrong baud rate."""
        return self._dice.randbytes(count)

    def answer(self, bus: Bus, data: bytes, baud: int, identifier: int) -> float:
        """Put an answer on the wire with what goes wrong now; return when it ends, s."""
        key, now = (bus.name, identifier, len(data)), bus.schedule.now
        fate, self._said[key] = Fate(data, self._said.get(key, data)), data
        for rule in [*self._rules]:
            if rule.kind in REQUESTS:
                continue
            if not rule.strikes(self._dice, bus.name, identifier, now) or not fate.got:
                continue  # what is lost already has nothing more to fear
            if rule.kind in EVENTS:
                self._begin(rule, bus, identifier, fate)
                continue
            self._note(rule.kind, bus.name, identifier)
            fate.suffer(rule.kind, rule.seconds, bus, self._dice)
        return self._sender.send(bus, data, baud, fate)

    def asked(self, bus: Bus) -> bool:
        """Whether the adapter gives the host back what it sends now."""
        echoes = False
        for rule in self._rules:
            now = bus.schedule.now
            if rule.kind == "echo" and rule.strikes(self._dice, bus.name, EVERYBODY, now):
                self._note(rule.kind, bus.name, EVERYBODY)
                echoes = True
        return echoes

    def _begin(self, rule: Rule, bus: Bus, identifier: int, fate: Fate) -> None:
        """Let an event begin with an answer of whom it can befall."""
        concerned = victims(rule, bus)
        if EVERYBODY not in concerned and identifier not in concerned:
            return
        self._happen(rule, bus, identifier)
        if rule.kind in SILENCING:
            fate.got = b""

    def _script(self, rule: Rule) -> None:
        """Note in the world's schedule what happens by itself."""
        if self._world is not None and rule.kind in EVENTS:
            for time in rule.at:
                self._world.schedule.at(time, partial(self._strike, rule))

    def _strike(self, rule: Rule) -> None:
        """Let a scripted event happen, unless it has been cleared; forget it after the last."""
        if self._world is None or not any(known is rule for known in self._rules):
            return
        self.happen(rule)
        if self._world.now >= rule.at[-1]:
            self._rules = [known for known in self._rules if known is not rule]
            self.active = bool(self._rules)

    def happen(self, rule: Rule) -> None:
        """Let an event happen now, to all whom it concerns; before `attach`, to nobody."""
        for bus in self._world.buses.values() if self._world is not None else ():
            concerned = victims(rule, bus)
            for identifier in concerned:
                self._happen(rule, bus, identifier)
            if concerned and rule.kind == "brown_out":  # everything has one supply
                return

    def _happen(self, rule: Rule, bus: Bus, identifier: int) -> None:
        """Do an event to one device, or to the bus."""
        self._note(rule.kind, bus.name, identifier)
        if self._world is not None:
            befall(rule, bus, identifier, self._world)

    def _note(self, kind: str, bus: str, identifier: int) -> None:
        self.counts[kind] += 1
        self.hits.append(Hit(self.now, kind, bus, identifier))
