"""An arm, a quadruped, one leg and thirty joints: load, stand, play, emulate, and no more."""

from pathlib import Path

import pytest

from tests.shapes import ARM, ONE_LEG, QUADRUPED, SHAPES, THIRTY, Shape, joint_names, write_shape
from tests.tools.conftest import Windup, refusal
from windup.robots import load_robot
from windup.tools.testing.servo_bus import ServoBus

EVERY = pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.name)
WALKING = {
    "walk": (),
    "push": ("--impulse", "0.1"),
    "stride": (),
    "step": ("--foot", "left", "--to", "0", "0.1"),
    "footprints": ("--random", "2"),
    "estimate": (),
    "rise": (),
}


@EVERY
def test_it_loads_with_all_its_joints(shape: Shape, tmp_path: Path) -> None:
    robot = load_robot(write_shape(tmp_path / "robot", shape))
    assert list(robot.joints.names) == joint_names(shape)
    assert robot.fixed == (not shape.floats)


@EVERY
def test_it_stands_on_its_twin(shell: Windup, shape: Shape, tmp_path: Path) -> None:
    ran = shell("stand", write_shape(tmp_path / "r", shape), "--seconds", "0.5", "--json", "-")
    assert ran.status == 0, ran.err
    assert ran.json["largest_error_deg"] < 3.0


@EVERY
def test_it_plays_a_graph(shell: Windup, shape: Shape, tmp_path: Path) -> None:
    ran = shell("play", write_shape(tmp_path / "r", shape), "nod", "--json", "-")
    assert (ran.status, ran.json["reason"]) == (0, "done"), ran.err


@EVERY
def test_it_stands_through_its_emulated_bus(shape: Shape, tmp_path: Path) -> None:
    with ServoBus(str(write_shape(tmp_path / "r", shape))) as bus:
        robot = bus.robot()
        assert robot.stand(0.3).reason == "done"
        assert not robot.fallen


@pytest.mark.parametrize("shape", [ARM, QUADRUPED, ONE_LEG], ids=lambda shape: shape.name)
@pytest.mark.parametrize("command", WALKING)
def test_what_takes_two_feet_is_refused_in_one_line(
    nothing_opens: None, command: str, shape: Shape, tmp_path: Path
) -> None:
    folder = write_shape(tmp_path / "r", shape)
    assert "cannot" in refusal([command, str(folder), *WALKING[command]])


def test_two_feet_of_no_side_are_asked_for_it(nothing_opens: None, tmp_path: Path) -> None:
    folder = write_shape(tmp_path / "r", THIRTY)
    file = folder / "robot.toml"
    file.write_text(file.read_text().replace('name = "left"', 'name = "paw"'))
    assert refusal(["walk", str(folder)]).endswith(
        'nobody says which side foot \'paw\' is on: give side = "left" or "right"'
    )
    file.write_text(file.read_text().replace('name = "paw"', 'name = "paw"\nside = "left"'))
    assert "unknown gait of thirty 'walk'" in refusal(["walk", str(folder)])


def test_ground_is_not_for_an_arm(nothing_opens: None, tmp_path: Path) -> None:
    folder = write_shape(tmp_path / "r", ARM)
    assert "is fixed" in refusal(["stand", str(folder), "--slope", "5"])


def test_ground_takes_a_floor_to_be_made_of(shell: Windup, tmp_path: Path) -> None:
    model = write_shape(tmp_path / "r", QUADRUPED) / "model.xml"
    model.write_text(model.read_text().replace('type="plane" size="0 0 0.05"', 'size="0.1"'))
    ran = shell("stand", tmp_path / "r", "--slope", "5")
    assert ran.status == 2 and "has no plane that other ground could replace" in ran.err


def test_the_arm_of_the_package_waves_and_folds_itself(shell: Windup) -> None:
    ran = shell("play", "so101", "wave", "--json", "-")
    assert (ran.status, ran.json["reason"]) == (0, "done"), ran.err
    assert ran.json["peak_load"] < 1.0


def test_the_arm_of_the_package_waves_through_its_bus() -> None:
    with ServoBus("so101") as bus:
        robot = bus.robot()
        assert robot.play("wave").reason == "done"
        robot.rest()
        assert not robot.armed


def test_a_hand_turns_a_limp_joint_of_an_arm() -> None:
    with ServoBus("so101") as bus:
        robot = bus.robot()
        index = robot.description.joints.index("elbow_flex")
        before = robot.backend.peek().joints.position[index]
        bus.hand("elbow_flex", 10.0, 0.5)
        bus.wait(0.25)
        assert abs(robot.backend.peek().joints.position[index] - before) > 0.01
