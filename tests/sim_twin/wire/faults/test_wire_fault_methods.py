"""Every fault by name: as a call, as text, and in its docstring."""

import inspect
import re

import pytest

from windup.sim_twin.wire import build_world, parse_address
from windup.sim_twin.wire.faults.fault_methods import FaultMethods
from windup.sim_twin.wire.faults.fault_rule import EVENTS, KINDS, make_rule
from windup.sim_twin.wire.faults.fault_text import format_rule, parse_rules
from windup.sim_twin.wire.faults.faults import Faults

NAMES = {"noise": "noisy"}
UNITS = {"seconds": ", s", "volts": ", V", "degrees": "degrees C", "speed": "rad/s"}


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_has_a_method_that_says_the_units_of_its_parameters(kind: str) -> None:
    method = getattr(FaultMethods, NAMES.get(kind, kind))
    asked = set(inspect.signature(method).parameters) & set(UNITS)
    for name in asked:
        line = re.search(rf"^ +{name}: (.+)$", method.__doc__, re.MULTILINE)
        assert line and UNITS[name] in line[1]
    (rule,) = getattr(Faults(), NAMES.get(kind, kind))()._rules
    assert rule.kind == kind


@pytest.mark.parametrize("kind", EVENTS)
def test_an_event_happens_now_unless_a_rate_or_a_time_is_given(kind: str) -> None:
    world = build_world(parse_address("twin://op3?physics=inertia"))
    world.advance(1.0)
    getattr(world.faults, kind)()
    assert world.faults.counts[kind] == 0
    world.advance(1.001)
    assert world.faults.counts[kind] >= 1
    (hit, *_) = world.faults.hits
    assert hit.time == 1.0


def test_an_event_with_a_rate_waits_for_an_answer() -> None:
    world = build_world(parse_address("twin://bench?servos=STS3215:1"))
    world.faults.reset(rate=0.5)
    world.advance(1.0)
    assert world.faults.counts["reset"] == 0


@pytest.mark.parametrize("kind", KINDS)
def test_a_fault_as_text_is_the_same_fault(kind: str) -> None:
    for rule in (make_rule(kind, 0.25), make_rule(kind, at=[0.5, 1.0], bus="body")):
        assert parse_rules(format_rule(rule)) == [rule]


def test_ids_and_seconds_are_in_the_text() -> None:
    text = format_rule(make_rule("late", 0.1, ids=[3, 1], seconds=0.003))
    assert text == "late:rate=0.1:ids=1;3:seconds=0.003"
