"""Hands that turn limp joints, and that hold a limp robot up, on the virtual clock."""

import math

import numpy as np
import pytest

from tests.sim_twin.wire.wire_host import Host, open_host
from tests.sim_twin.wire.wire_host1 import open_host1
from windup.hal.errors import UnknownNameError, UsageError
from windup.sim_twin.twin import Twin
from windup.sim_twin.wire.protocols.frames import encode
from windup.sim_twin.wire.shafts.twin_shaft import TwinPhysics
from windup.sim_twin.wire.world.address import parse_address
from windup.sim_twin.wire.world.build import build_world
from windup.sim_twin.wire.world.hand import HandMotion, parse_hands

KNEE = 13  # the id of op3's right knee
IDS = tuple(range(1, 21))


def test_a_text_says_joints_degrees_and_seconds() -> None:
    assert parse_hands(" r_knee:90:3s , 7:-180:0.5 ") == [
        HandMotion("r_knee", math.pi / 2.0, 3.0),
        HandMotion("7", -math.pi, 0.5),
    ]
    assert parse_hands("") == []


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("r_knee", "a joint, degrees and seconds, as in 'r_knee:20:3s"),
        (":20:3s", "a joint, degrees and seconds"),
        ("r_knee:up:3s", "degrees: 'up' is no number"),
        ("r_knee:500:3s", "give -360 .. 360 degrees"),
        ("r_knee:20:0s", "give 0.01 .. 3600 s"),
        ("r_knee:20:nan", "give a finite number of s"),
    ],
)
def test_another_text_is_told_what_is_wrong(text: str, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        parse_address(f"twin://op3?hand={text}")


def test_a_joint_that_is_not_there_is_named() -> None:
    with pytest.raises(UnknownNameError, match=r"unknown joint 'r_kne'; did you mean 'r_knee'"):
        build_world(parse_address("twin://op3?physics=inertia&hand=r_kne:20:3s"))


def test_a_client_that_records_the_range_of_a_limp_servo_finds_it() -> None:
    with open_host1("twin://bench?servos=STS3215:1-2&hand=1:90:2s") as host:
        host.place(1, 1000)
        seen = []
        for _ in range(80):
            host.wait(0.05)
            seen.append(host.read(1, "present_position"))
        assert min(seen) == pytest.approx(1000, abs=4)
        assert max(seen) == pytest.approx(2024, abs=4)
        assert host.read(2, "present_position") == 2048


def test_a_hand_leaves_a_driven_joint_alone_and_begins_anew_behind_that() -> None:
    with open_host("twin://bench?servos=XM430-W350:1&hand=1:90:1s&return_delay=0") as host:
        host.wait(0.5)
        assert host.read(1, "present_velocity") > 0
        host.write(1, "torque_enable", 1)
        held = host.read(1, "goal_position")
        host.wait(2.0)
        assert host.read(1, "present_position") == pytest.approx(held, abs=30)
        host.write(1, "torque_enable", 0)
        host.wait(1.0)
        assert host.read(1, "present_position") == pytest.approx(held + 1024, abs=40)


@pytest.mark.parametrize("physics", ["mujoco", "inertia"])
def test_a_robots_joint_is_turned_as_its_file_counts_angles(physics: str) -> None:
    with open_host(f"twin://op3?physics={physics}&return_delay=0", baud=2_000_000) as host:
        grip = host.world.grips["r_knee"]
        others = {name: other.angle() for name, other in host.world.grips.items()}
        before, counts = grip.angle(), host.read(KNEE, "present_position")
        host.world.hand(HandMotion("r_knee", math.radians(20.0), 1.0))
        host.wait(1.0)
        assert grip.angle() - before == pytest.approx(math.radians(20.0), abs=1e-4)
        moved = abs(host.read(KNEE, "present_position") - counts)
        assert moved == pytest.approx(20.0 / 360.0 * 4096, abs=2)
        del others["r_knee"]
        assert {name: host.world.grips[name].angle() for name in others} == others


def switch(host: Host, on: bool) -> None:
    body = bytes((64, 0, 1, 0)) + b"".join(bytes((k, on)) for k in IDS)
    host.port.write(encode(254, 0x83, body))
    host.wait(0.01)


def twin_of(host: Host) -> Twin:
    (twin,) = host.world.owned
    assert isinstance(twin, Twin)
    return twin


def test_hands_that_always_hold_take_a_limp_robot_again() -> None:
    with open_host("twin://op3?hold=always&return_delay=0", baud=2_000_000) as host:
        twin, physics = twin_of(host), host.world.physics
        assert isinstance(physics, TwinPhysics)
        for _ in range(2):
            switch(host, True)
            assert not physics.held
            host.wait(0.5)
            switch(host, False)
            host.wait(0.01)
            limp = twin.data.qpos.copy()
            host.wait(2.0)
            assert physics.held and not twin.fallen
            assert np.array_equal(twin.data.qpos, limp)


def test_hands_put_a_robot_that_has_fallen_where_it_began() -> None:
    with open_host("twin://op3?hold=always&return_delay=0", baud=2_000_000) as host:
        twin = twin_of(host)
        began = twin.data.qpos.copy()
        switch(host, True)
        twin.data.qvel[3:6] = 0.0, 6.0, 0.0  # somebody tips it over
        host.wait(2.0)
        assert twin.fallen
        switch(host, False)
        host.wait(0.1)
        assert not twin.fallen and np.array_equal(twin.data.qpos, began)
