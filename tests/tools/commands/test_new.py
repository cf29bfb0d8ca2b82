"""What `windup new` writes works at once, and nothing is overwritten."""

import shlex
from pathlib import Path

import pytest

from tests.tools.conftest import Windup, refusal
from windup.robots import load_robot, robot_names
from windup.tools.testing.servo_bus import ServoBus

FALL_BY_THEMSELVES = {"human", "human12", "human_handstand"}
"""Their soft joints hold no pose for long: `windup stand` falls with them too."""


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_every_command_that_a_new_robot_suggests_succeeds(shell: Windup, here: Path) -> None:
    ran = shell("new", "robot", "rex", "--json", "-")
    assert ran.status == 0, ran.err
    assert set(ran.json["files"]) == {"rex/robot.toml", "rex/model.xml", "rex/gaits/squat.toml"}
    for line in ran.json["next"]:
        assert f"next: {line}" in ran.err
        did = shell(*shlex.split(line)[1:])
        assert did.status == 0, f"{line}: {did.err}"
    assert (here / "rex.png").exists()


def test_a_new_robot_raises_no_doubt(shell: Windup, here: Path) -> None:
    shell("new", "robot", "rex")
    ran = shell("check", "rex", "--json", "-")
    assert (ran.json["errors"], ran.json["warnings"]) == ([], [])
    assert len(load_robot("rex").joints) == 12


def test_a_new_robot_is_the_mirror_image_of_itself(shell: Windup, here: Path) -> None:
    shell("new", "robot", "rex")
    robot = load_robot("rex")
    assert (robot.mirror(robot.stance) == robot.stance).all()


def test_a_new_robot_stands_on_its_emulated_bus(shell: Windup, here: Path) -> None:
    shell("new", "robot", "rex")
    with ServoBus("rex") as bus:
        robot = bus.robot()
        assert robot.stand(1.0).reason == "done"
        assert not robot.fallen


@pytest.mark.parametrize("name", sorted(set(robot_names()) - FALL_BY_THEMSELVES))
def test_a_new_gait_plays_on_every_robot_that_stands(shell: Windup, here: Path, name: str) -> None:
    ran = shell("new", "gait", "nod", "--robot", name, "--json", "-")
    assert ran.json["files"] == ["nod.toml"]
    assert ran.json["next"] == [f"windup play {name} nod.toml"]
    played = shell("play", name, "nod.toml", "--json", "-")
    assert (played.status, played.json["reason"]) == (0, "done"), played.err


def test_a_new_gait_goes_into_ones_own_robot(shell: Windup, here: Path) -> None:
    shell("new", "robot", "rex")
    ran = shell("new", "gait", "nod", "--robot", "rex", "--json", "-")
    assert ran.json["files"] == ["rex/gaits/nod.toml"]
    assert ran.json["next"] == ["windup play rex nod"]
    played = shell("play", "rex", "nod", "--json", "-")
    assert (played.status, played.json["reason"]) == (0, "done"), played.err


@pytest.mark.parametrize("robot", ["op3", "rex"])
def test_a_new_controller_runs(shell: Windup, here: Path, robot: str) -> None:
    shell("new", "robot", "rex")
    ran = shell("new", "controller", "head_shake", "--robot", robot, "--json", "-")
    assert ran.json["next"] == [f"windup run {robot} head_shake.py"]
    text = (here / "head_shake.py").read_text()
    assert "class HeadShakeController:" in text and f"windup run {robot} head_shake.py" in text
    did = shell(*shlex.split(ran.json["next"][0])[1:], "--period", "1", "--json", "-")
    assert (did.status, did.json["reason"]) == (0, "done"), did.err
    assert did.json["behaviour"] == "HeadShakeController"


@pytest.mark.parametrize("name", ["rex/robot.toml", "rex/gaits/squat.toml"])
def test_no_file_of_a_robot_is_overwritten(here: Path, name: str) -> None:
    path = here / name
    path.parent.mkdir(parents=True)
    path.write_text("mine")
    assert f"{name} is there already" in refusal(["new", "robot", "rex"])
    assert path.read_text() == "mine"
    assert [file for file in here.rglob("*") if file.is_file()] == [path]


@pytest.mark.parametrize(("kind", "name"), [("gait", "nod.toml"), ("controller", "nod.py")])
def test_no_gait_or_controller_is_overwritten(here: Path, kind: str, name: str) -> None:
    (here / name).write_text("mine")
    assert f"{name} is there already" in refusal(["new", kind, "nod"])
    assert (here / name).read_text() == "mine"


NAMES = {
    "a robot of ours": ("robot", "op3", "there is a robot op3 already: give yours another name"),
    "no word": ("robot", "my robot", "'my robot' is no name for a robot: letters, digits"),
    "no module": ("controller", "my-one", "'my-one' is no name for a file of Python"),
    "a keyword": ("controller", "lambda", "'lambda' is no name for a file of Python"),
    "the standard library's": ("controller", "signal", "signal.py would hide a module"),
    "ours": ("controller", "windup", "windup.py would hide a module"),
    "no folder": ("gait", "a/b/nod", "cannot be written: there is no folder"),
}


@pytest.mark.parametrize(("kind", "name", "said"), NAMES.values(), ids=NAMES)
def test_a_name_that_cannot_be_is_one_line(here: Path, kind: str, name: str, said: str) -> None:
    assert said in refusal(["new", kind, name])
    assert list(here.iterdir()) == []
