"""Faults that could never happen are refused before anything runs, and spaces do no harm."""

import math
import re

import pytest

from windup.hal.errors import UsageError
from windup.sim_twin.wire import parse_address
from windup.sim_twin.wire.faults.fault_text import parse_rules
from windup.sim_twin.wire.world.build import build_world

BENCH = "twin://bench?servos=STS3215:1-4&faults="


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("dead:id=7", "'dead:id=7': unknown key 'id'; did you mean 'ids'?"),
        ("drop:0.01:volts=3", "drop: takes no volts; only brown_out does"),
        ("drop:0.01:seconds=3", "drop: takes no seconds; these do: late, delay, glue, late_byte"),
        ("dead:ids=7-5", "'dead:ids=7-5': a rate from 0 to 1, keys, ids up to 253"),
        ("reset:at=nan", "reset: at nan: give a finite number of s"),
        ("unplug:seconds=nan", "unplug: seconds nan: give a finite number of s"),
        ("brown_out:volts=nan", "brown_out: volts nan: give a finite number of V"),
        ("brown_out:volts=-1", "brown_out: volts -1: give 0 .. 60 V"),
        ("heat:degrees=inf", "heat: degrees inf: give a finite number of degrees C"),
        ("imu_spin:degrees=3", "imu_spin: takes no degrees; only heat does"),
        ("drop:speed=3", "drop: takes no speed; only imu_spin does"),
        ("echo:ids=3", "echo: takes no ids; it applies to all bytes that the host sends"),
    ],
)
def test_a_key_that_means_nothing_is_refused_by_name(text: str, message: str) -> None:
    with pytest.raises(UsageError, match=re.escape(message)):
        parse_rules(text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("drop:ids=99", "drop: no servo has id 99; ids here: 1, 2, 3, 4"),
        ("drop:bus=legs", "drop: unknown bus 'legs'; known: bench"),
        ("imu_frozen", "imu_frozen: there is no IMU in this world"),
        ("button", "button: there is no OpenCR in this world"),
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


def test_what_has_an_end_can_last_for_ever() -> None:
    for rule in parse_rules("brown_out:volts=9:seconds=inf,unplug:seconds=inf"):
        assert rule.seconds == math.inf


def test_keys_that_are_left_out_have_their_defaults() -> None:
    heat, spin, button, frozen = parse_rules("heat,imu_spin,button,imu_frozen")
    assert (heat.degrees, heat.seconds) == (75.0, math.inf)
    assert (spin.speed, spin.seconds) == (3.0, math.inf)
    assert (button.seconds, frozen.seconds) == (0.2, math.inf)


def test_a_text_for_a_world_that_runs_means_its_events_now() -> None:
    unplug, later, share, drop = parse_rules("unplug,reset:at=2,overload:0.1,drop", live=True)
    assert (unplug.at, later.at, share.at, drop.at) == ([0.0], [2.0], [], [])
    assert (share.rate, drop.rate) == (0.1, 0.01)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("dorp:1", "unknown kind 'dorp'; did you mean 'drop'?"),
        ("drop:2", "drop: rate 2: give 0 .. 1"),
        ("drop:x", "'drop:x': a rate from 0 to 1, keys, ids up to 253, as in"),
        ("drop:0.1:at=3", "give a rate or a time, not both"),
        ("drop:0.1:id=3", "'drop:0.1:id=3': unknown key 'id'; did you mean 'ids'?"),
        ("unplug:at=-1", "unplug: at -1: give 0 .. 1000000000 s"),
    ],
)
def test_a_wrong_text_says_what_is_wrong(text: str, message: str) -> None:
    with pytest.raises(UsageError, match=message.replace("?", r"\?")):
        parse_rules(text)


def test_a_text_says_everything_that_the_methods_do() -> None:
    (late, unplug) = parse_rules("late:0.02:seconds=0.003:ids=1-3;9:bus=legs,unplug:at=2.5;4")
    assert (late.rate, late.seconds, late.bus) == (0.02, 0.003, "legs")
    assert late.ids == frozenset((1, 2, 3, 9))
    assert (unplug.at, unplug.seconds) == ([2.5, 4.0], 0.5)
    assert parse_rules("drop")[0].rate == 0.01
