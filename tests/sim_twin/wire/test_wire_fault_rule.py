"""Faults that could never happen are refused before anything runs, and spaces do no harm."""

import re

import pytest

from hal.errors import UsageError
from sim_twin.wire import parse_address
from sim_twin.wire.build import build_world
from sim_twin.wire.fault_rule import parse_rules

BENCH = "twin://bench?servos=STS3215:1-4&faults="


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("dead:id=7", "'dead:id=7': unknown key 'id'; did you mean 'ids'?"),
        ("drop:0.01:volts=3", "drop: takes no volts; only brown_out does"),
        ("drop:0.01:seconds=3", "drop: takes no seconds; these do: late, delay, glue"),
        ("dead:ids=7-5", "'dead:ids=7-5': a rate from 0 to 1, keys, ids up to 253"),
        ("reset:at=nan", "reset: at nan: give a finite number of s"),
    ],
)
def test_a_key_that_means_nothing_is_refused_by_name(text: str, message: str) -> None:
    with pytest.raises(UsageError, match=re.escape(message)):
        parse_rules(text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("drop:ids=99", "drop: nobody has id 99; there are 1, 2, 3, 4"),
        ("drop:bus=legs", "drop: unknown bus 'legs'; known: bench"),
    ],
)
def test_a_fault_of_nobody_is_refused_when_the_world_is_built(text: str, message: str) -> None:
    with pytest.raises(UsageError, match=re.escape(message)):
        build_world(parse_address(BENCH + text))


def test_a_range_of_ids_may_reach_beyond_the_servos() -> None:
    world = build_world(parse_address(BENCH + "drop:1:ids=3-9"))
    assert [device.identifier for device in world.devices] == [1, 2, 3, 4]


def test_spaces_do_not_count() -> None:
    assert parse_rules(" drop: 0.02, cut:ids=1 ") == parse_rules("drop:0.02,cut:ids=1")
