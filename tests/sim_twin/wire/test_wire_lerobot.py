"""Every call of LeRobot's unmodified motor buses on emulated servos, in real time."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.sim_twin.wire.clients.run import run_client
from tests.sim_twin.wire.emulator_process import emulator

HANDS = "hand=1:40:0.5s,2:-40:0.5s"
SERVOS = {
    "sts": ("STS3215:1-3", 777),
    "x": ("XL330-M288:1-3&supply=5&return_delay=100", 1200),
}
TURN = 455  # counts of a hand's 40 degrees
STUBS = {  # of what LeRobot imports beside its motors
    "torch.py": "device = dtype = object",
    "accelerate.py": "Accelerator = object",
    "datasets/utils/logging.py": "disable_progress_bar = enable_progress_bar = None",
}
Run = Callable[..., dict[str, Any]]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder: Path = tmp_path_factory.mktemp("lerobot")
    for name, text in STUBS.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)

    def lerobot(servos: str, script: str, *arguments: str) -> dict[str, Any]:
        with emulator(f"twin://bench?servos={servos}", folder / "servos") as name:
            found: dict[str, Any] = run_client(
                script, *arguments, name, package="lerobot", paths=[folder]
            )
        return found

    return lerobot


@pytest.fixture(scope="module", params=["sts", "x"])
def said(run: Run, request: pytest.FixtureRequest) -> dict[str, Any]:
    servos, model = SERVOS[request.param]
    return {"model": model, **run(f"{servos}&{HANDS}", "lerobot", request.param)}


def test_it_makes_every_call_but_the_set_up_of_a_single_motor(said: dict[str, Any]) -> None:
    assert said["uncalled"] == ["setup_motor"]  # below


def test_it_finds_its_motors(said: dict[str, Any]) -> None:
    assert said["scan"] == {"1000000": [1, 2, 3]}
    assert said["connected"] and not said["left"]
    assert said["ids"] == [1, 2, 3] and len(set(said["models"])) == 1
    assert said["pings"] == [said["model"]] * 3
    assert said["all"] == {str(id): said["model"] for id in (1, 2, 3)}
    assert said["baud"] == 1_000_000
    assert said["delay"] == [0, 0, 0]


def test_it_makes_the_middle_of_where_they_are(said: dict[str, Any]) -> None:
    assert said["offsets"] == said["made"]
    assert abs(said["offsets"]["c"]) == 1  # from 2048, and nobody moves it
    assert said["middle"]["c"] == 2047
    for name in "ab":  # hands do
        assert said["middle"][name] == pytest.approx(2047, abs=TURN)
    assert (said["before"], said["after"]) == (False, True)


def test_it_records_how_far_hands_turn_them(said: dict[str, Any]) -> None:
    for name in "ab":
        assert said["maxes"][name] - said["mins"][name] == pytest.approx(TURN, abs=15)


def test_it_drives_them_in_its_own_units(said: dict[str, Any]) -> None:
    assert said["reached"] == pytest.approx({"a": -50.0, "b": 75.0, "c": 20.0}, abs=3.0)
    assert said["alone"] == pytest.approx(-20.0, abs=3.0)
    assert said["gain"] in (16, 300)
    assert said["limp"] == {"a": 0, "b": 0, "c": 1}
    assert said["held"] == {"a": 1, "b": 1, "c": 1}
    assert said["reset"] == [0, 4095]


@pytest.mark.parametrize(
    ("family", "servo", "model"),
    [("sts", "STS3215:1&baud=500000", 777), ("x", "XL330-M288:1&supply=5&baud=57600", 1200)],
)
def test_it_gives_a_new_motor_its_id_and_baud_rate(
    run: Run, family: str, servo: str, model: int
) -> None:
    said = run(servo, "lerobot", f"setup-{family}")
    assert said == {"renamed": model, "baud": 1_000_000, "old": None}


def test_it_drives_scs_servos_one_by_one(run: Run) -> None:
    said = run("SCS0009:1-2&supply=6", "lerobot_scs")
    assert said["uncalled"] == []
    assert (said["pings"], said["baud"]) == ([1284, 1284], 1_000_000)
    # That there is neither sync read nor homing offset is LeRobot's to know, before it asks.
    no_sync, no_offset = "NotImplementedError", "KeyError"
    assert said["refused"] == [no_sync, no_sync, no_sync, no_offset, no_sync]
    assert said["calibrated"] and said["limits"] == [[200, 800]] * 2
    assert said["reached"] == pytest.approx([20.0, -50.0], abs=2.0)
    assert (said["limp"], said["held"]) == ([0, 1], [1, 1])
    assert said["renamed"] == 1284
