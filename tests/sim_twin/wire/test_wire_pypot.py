"""Every call of unmodified pypot's bus class on emulated AX and MX servos, in real time."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.sim_twin.wire.clients.run import run_client
from tests.sim_twin.wire.emulator_process import emulator

BUS = "twin://bench?servos=MX-28:1-2,MX-106:3,AX-12A:4&return_delay=0"
HOT = ["Overheating Error"]


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Any]]:
    path: Path = tmp_path_factory.mktemp("pypot") / "servos"
    with emulator(BUS, path) as name:
        yield run_client("pypot", name, package="pypot")


def test_it_makes_every_call_but_those_for_another_makers_hand(said: dict[str, Any]) -> None:
    seed_robotics = ["force_control_enable", "goal_force"]
    assert said["uncalled"] == [f"{way}_{name}" for way in ("get", "set") for name in seed_robotics]


def test_it_finds_the_servos_and_their_health(said: dict[str, Any]) -> None:
    assert said["found"] == [1, 2, 3, 4]
    assert said["models"] == ["MX-28", "MX-28", "MX-106", "AX-12"]
    assert said["firmware"] == [36, 36, 36, 24]
    assert said["used"] and said["closed"]
    assert said["volts"] == [12.0] * 4
    assert said["warmth"] == pytest.approx([25.0] * 4, abs=3.0)
    assert said["current"] == [0.0]


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("return_delay_time", [20] * 4),
        ("highest_temperature_limit", [65.0] * 4),
        ("voltage_limit", [[7.0, 14.0]] * 4),
        ("max_torque", [80.0] * 4),
        ("torque_limit", [70.0] * 4),
        ("alarm_LED", [HOT] * 4),
        ("alarm_shutdown", [HOT] * 4),
        ("status_return_level", ["read"] * 4),
        ("pid_gain", [[5.0, 1.953125, 0.4]] * 3),
        ("drive_mode", [["reverse", "master"]]),
        ("compliance_margin", [[2, 3]]),
        ("compliance_slope", [[64, 16]]),
        ("punch", [40]),
    ],
)
def test_it_reads_what_it_has_set(said: dict[str, Any], name: str, value: Any) -> None:
    assert said["settings"][name] == value


def test_it_reads_what_it_has_set_to_the_next_count(said: dict[str, Any]) -> None:
    settings = said["settings"]
    assert settings["moving_speed"] == pytest.approx([180.0] * 4, abs=0.4)
    assert settings["goal_acceleration"] == pytest.approx([858.3])
    for limits in settings["angle_limit"]:
        assert limits == pytest.approx([-100.0, 100.0], abs=0.3)
    assert said["led"] == [[True, True], [False, False]]


def test_it_reads_whole_control_tables(said: dict[str, Any]) -> None:
    for id, table in enumerate(said["tables"], start=1):
        assert (table["model"], table["id"]) == (said["models"][id - 1], id)
        assert table["status return level"] == "read"
        assert not table["torque_enable"] and not table["moving"]
        assert table["present position"] == pytest.approx(0.0, abs=0.2)


def test_it_moves_them(said: dict[str, Any]) -> None:
    assert said["torque"] == [True] * 4
    assert said["moving"]
    assert said["reached"] == pytest.approx([40.0, -40.0, 10.0, 30.0], abs=2.0)
    assert said["goals"] == pytest.approx([40.0, -40.0, 10.0, 30.0], abs=0.2)
    for goal in said["three"]:
        assert goal == pytest.approx([0.0, 90.0, 60.0], abs=0.4)
    assert said["again"] == pytest.approx([0.0] * 4, abs=2.0)
    assert [position for position, _, _ in said["present"]] == pytest.approx([0.0] * 4, abs=3.0)
    assert said["limp"] == [False] * 4


def test_it_turns_wheels_and_sees_their_direction(said: dict[str, Any]) -> None:
    assert said["wheels"] == ["wheel", "joint", "joint", "wheel"]
    backward, forward = said["turning"]
    assert backward < -80.0 and forward > 20.0
    assert said["loads"][0] < 0.0 < said["loads"][1]
    assert said["joints"] == [[[0, 4095]], [[0, 1023]]]
    assert said["modes"] == ["joint"] * 4


def test_it_silences_renames_and_resets_a_servo(said: dict[str, Any]) -> None:
    assert said["mute"] == ["never"]
    assert not said["absent"] and said["renamed"]
    assert said["factory"] and said["delay"] == [500]


def test_it_hears_of_a_supply_out_of_its_limits(said: dict[str, Any]) -> None:
    assert said["alarms"] > 0
