"""Faults of answers, servos, supply and adapter, seeded, so that a run can be had again."""

import math
import random
from collections import deque
from collections.abc import Iterable
from functools import partial
from typing import TYPE_CHECKING, NamedTuple, Self, TypedDict, Unpack

from sim_twin.wire.fault_rule import EVENTS, KINDS, Rule, Times, make_rule, parse_rules

if TYPE_CHECKING:
    from sim_twin.wire.bus import Bus
    from sim_twin.wire.inbox import Burst
    from sim_twin.wire.world import World

EVERYBODY = -1
IDS = 253
REMEMBERED = 10_000  # hits


class When(TypedDict, total=False):
    """How often a fault happens, or when.

    Attributes:
        rate: Share of the answers that it hits; 0.01 by default.
        at: Instead of a rate the time, s, or several: the first answer from then on is hit, or
            servos, supply and adapter at that very moment.
        bus: The bus it is confined to.
    """

    rate: float
    at: Times
    bus: str


class Who(When, total=False):
    """How often or when, and whom.

    Attributes:
        ids: The ids that can be hit; everybody by default.
    """

    ids: Iterable[int]


class Hit(NamedTuple):
    """One fault that happened: when (s), what, on which bus, to which id (-1: everybody)."""

    time: float
    kind: str
    bus: str
    identifier: int


class Faults:
    """What goes wrong on the buses of a world.

    Every method adds one kind of fault and returns the object, so that calls can be chained. See
    `Who` for their keywords.

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
        self._world: World | None = None
        self._glued: dict[str, Burst] = {}

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

    def drop(self, **who: Unpack[Who]) -> Self:
        """Lose answers."""
        return self.add(make_rule("drop", **who))

    def corrupt(self, **who: Unpack[Who]) -> Self:
        """Change one byte of answers."""
        return self.add(make_rule("corrupt", **who))

    def cut(self, **who: Unpack[Who]) -> Self:
        """Lose the end of answers."""
        return self.add(make_rule("cut", **who))

    def noisy(self, **who: Unpack[Who]) -> Self:
        """Put up to eight random bytes before answers."""
        return self.add(make_rule("noise", **who))

    def late(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let servos answer late; those behind them in a sync read wait."""
        return self.add(make_rule("late", seconds=seconds, **who))

    def delay(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Let the adapter hold answers back for some seconds, and what comes behind them."""
        return self.add(make_rule("delay", seconds=seconds, **who))

    def wrong_id(self, **who: Unpack[Who]) -> Self:
        """Have answers come from another id, with a checksum that fits."""
        return self.add(make_rule("wrong_id", **who))

    def wrong_length(self, **who: Unpack[Who]) -> Self:
        """Change the length byte of answers."""
        return self.add(make_rule("wrong_length", **who))

    def glue(self, seconds: float | None = None, **who: Unpack[Who]) -> Self:
        """Hold answers back until the next one is there, for some seconds at most."""
        return self.add(make_rule("glue", seconds=seconds, **who))

    def dead(self, **who: Unpack[Who]) -> Self:
        """Let servos die: no answer and no torque, for ever."""
        return self.add(make_rule("dead", **who))

    def reset(self, **who: Unpack[Who]) -> Self:
        """Let servos start again: torque off, RAM as after power-up."""
        return self.add(make_rule("reset", **who))

    def brown_out(
        self, volts: float = 0.0, seconds: float | None = None, **when: Unpack[When]
    ) -> Self:
        """Let the supply of everything sink to `volts` V for some seconds."""
        return self.add(make_rule("brown_out", volts=volts, seconds=seconds, **when))

    def overload(self, **who: Unpack[Who]) -> Self:
        """Make servos take themselves for overloaded."""
        return self.add(make_rule("overload", **who))

    def unplug(self, seconds: float | None = None, **when: Unpack[When]) -> Self:
        """Pull the adapter out, and put it in again after some seconds (`math.inf`: never)."""
        return self.add(make_rule("unplug", seconds=seconds, **when))

    def add(self, rule: Rule) -> Self:
        """Add a fault."""
        self._rules.append(rule)
        self.active = True
        self._script(rule)
        return self

    def clear(self) -> Self:
        """Let nothing go wrong any more; what is broken stays broken."""
        self._rules.clear()
        self.active = False
        return self

    def attach(self, world: "World") -> None:
        """Take the world into which scripted faults go.

        Raises:
            UsageError: A fault concerns a bus or servos that are not in it.
        """
        if self._world is None:
            for rule in self._rules:
                rule.check_target(
                    {b.name: [d.identifier for d in b.devices] for b in world.buses.values()}
                )
            self._world = world
            for rule in self._rules:
                self._script(rule)

    def noise(self, count: int) -> bytes:
        """Return bytes as of a collision or a wrong baud rate."""
        return self._dice.randbytes(count)

    def answer(self, bus: "Bus", data: bytes, baud: int, identifier: int) -> float:
        """Put an answer on the wire with what goes wrong now; return when it ends, s."""
        now, got, late, held, glued = bus.schedule.now, data, 0.0, 0.0, 0.0
        for rule in [*self._rules]:
            if not rule.strikes(self._dice, bus.name, identifier, now) or not got:
                continue  # what is lost already has nothing more to fear
            if rule.kind in EVENTS:
                self._happen(rule, bus, identifier)
                got = got if rule.kind == "overload" else b""
                continue
            self._note(rule.kind, bus.name, identifier)
            if rule.kind == "late":
                late += rule.seconds
            elif rule.kind == "delay":
                held = max(held, now + rule.seconds)
            elif rule.kind == "glue":
                glued = rule.seconds
            else:
                got = self._spoil(rule.kind, got, bus)
        put = partial(self._put, bus, data, baud, got, held, glued)
        if late <= 0.0:
            return put()
        bus.schedule.at(now + late, put)
        return now + late + len(data) * 10.0 / baud

    def _put(
        self, bus: "Bus", data: bytes, baud: int, got: bytes, held: float, glued: float
    ) -> float:
        """Put an answer on the wire; one that was glued to it comes with its last byte."""
        end = bus.put(data, baud, got, math.inf if glued else held)
        burst = bus.inbox.last
        if not got or burst is None:
            return end
        waiting = self._glued.pop(bus.name, None)
        if waiting is not None and waiting.held == math.inf:
            waiting.held = end
            burst.held = max(burst.held, end)
        if glued:
            self._glued[bus.name] = burst
            bus.schedule.at(end + glued, partial(_release, burst, end + glued))
        return end

    def _spoil(self, kind: str, data: bytes, bus: "Bus") -> bytes:
        """Return what the host gets of an answer."""
        dice, language = self._dice, bus.language
        if not data or kind == "drop":
            return b""
        if kind == "cut":
            return data[: dice.randrange(len(data))]
        if kind == "noise":
            return dice.randbytes(dice.randint(1, 8)) + data
        place = {"wrong_id": language.id_at, "wrong_length": language.length_at}.get(kind)
        if place is None or place >= len(data):
            place = dice.randrange(len(data))
        changed = data[place] ^ dice.randrange(1, 256)
        if kind == "wrong_id":
            changed = (data[place] + dice.randrange(1, IDS)) % IDS
        spoilt = data[:place] + bytes((changed,)) + data[place + 1 :]
        return language.seal(spoilt) if kind == "wrong_id" else spoilt

    def _script(self, rule: Rule) -> None:
        """Note in the world's schedule what happens by itself."""
        if self._world is not None and rule.kind in EVENTS:
            for time in rule.at:
                self._world.schedule.at(time, partial(self._strike, rule))

    def _strike(self, rule: Rule) -> None:
        """Let a scripted event happen, unless it has been cleared."""
        if any(known is rule for known in self._rules):
            self.happen(rule)

    def happen(self, rule: Rule) -> None:
        """Let an event happen now, to all whom it concerns; before `attach`, to nobody."""
        for bus in self._world.buses.values() if self._world is not None else ():
            if rule.bus not in (None, bus.name):
                continue
            if rule.kind in ("unplug", "brown_out"):
                self._happen(rule, bus, EVERYBODY)
                if rule.kind == "brown_out":
                    return
                continue
            for device in bus.devices:
                if rule.concerns(bus.name, device.identifier):
                    self._happen(rule, bus, device.identifier)

    def _happen(self, rule: Rule, bus: "Bus", identifier: int) -> None:
        """Do an event to one servo, or to the bus."""
        self._note(rule.kind, bus.name, identifier)
        now, world = bus.schedule.now, self._world
        if rule.kind == "unplug":
            bus.plug(False)
            if rule.seconds < math.inf:
                bus.schedule.at(now + rule.seconds, partial(bus.plug, True))
        elif rule.kind == "brown_out" and world is not None:
            bus.schedule.at(now + rule.seconds, world.recover)
            world.sag(rule.volts)
        for device in [*bus.devices]:
            if device.identifier != identifier:
                continue
            if rule.kind == "reset":
                device.reboot(now)
                bus.refresh()
            elif rule.kind == "overload":
                device.overload(now)
            elif rule.kind == "dead" and world is not None:
                world.kill(device)

    def _note(self, kind: str, bus: str, identifier: int) -> None:
        self.counts[kind] += 1
        now = 0.0 if self._world is None else self._world.now
        self.hits.append(Hit(now, kind, bus, identifier))


def _release(burst: "Burst", time: float) -> None:
    """Stop waiting for an answer to glue to."""
    if burst.held == math.inf:
        burst.held = time
