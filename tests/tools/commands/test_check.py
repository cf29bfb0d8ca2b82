"""`windup check`: everything at once, as text, JSON, picture and exit status."""

from pathlib import Path

import pytest

from tests.shapes import ARM, THIRTY, add_table, write_shape
from tests.tools.conftest import Windup, refusal

PNG = b"\x89PNG\r\n"


def test_a_sound_robot_has_status_0_and_a_picture(shell: Windup, tmp_path: Path) -> None:
    folder, plot = write_shape(tmp_path / "r", THIRTY), tmp_path / "r.png"
    ran = shell("check", folder, "--plot", plot, "--json", "-")
    assert ran.status == 0, ran.err
    assert ran.json["errors"] == [] and ran.json["warnings"] == []
    assert ran.json["robot"] == "thirty" and ran.json["gaits"] == ["nod"]
    assert ran.json["mass"] == pytest.approx(0.4 + 30 * 0.02 + 2 * 0.02)
    assert len(ran.json["joints"]) == 30
    assert plot.read_bytes().startswith(PNG)
    assert ran.err.splitlines()[-2:] == ["thirty: 0 errors, 0 warnings", f"picture: {plot}"]


@pytest.mark.parametrize("broken", [False, True])
def test_a_table_in_the_mjcf_is_no_part_of_the_robot(
    shell: Windup, tmp_path: Path, broken: bool
) -> None:
    folder = write_shape(tmp_path / "r", THIRTY)
    add_table(folder)
    if broken:
        (folder / "robot.toml").write_text('name = "thirty"')
    ran = shell("check", folder, "--json", "-")
    assert ran.status == (2 if broken else 0), ran.err
    assert ran.json["mass"] == pytest.approx(0.4 + 30 * 0.02 + 2 * 0.02)


def test_all_that_is_wrong_and_doubtful_is_said_with_status_2(
    shell: Windup, tmp_path: Path
) -> None:
    folder = write_shape(tmp_path / "r", THIRTY)
    robot, gait = folder / "robot.toml", folder / "gaits" / "nod.toml"
    robot.write_text("colour = 3\n" + robot.read_text().replace("height = 0.05", "height = 0.5"))
    gait.write_text(gait.read_text().replace("= 4 }", "= 400 }"))
    ran = shell("check", folder, "--json", "-")
    assert ran.status == 2
    lines = ran.err.splitlines()
    assert "error: robot.toml: colour: unknown key; " in ran.err
    assert "error: gaits/nod.toml: state.nod.pose.arm3_5: 400 degrees is outside" in ran.err
    assert "warning: fall.height 0.5 m" in ran.err
    assert lines[-1] == "thirty: 2 errors, 1 warning"
    assert [len(ran.json[key]) for key in ("errors", "warnings")] == [2, 1]


def test_a_robot_that_cannot_be_read_still_has_a_picture_of_its_mjcf(
    shell: Windup, tmp_path: Path
) -> None:
    folder, plot = write_shape(tmp_path / "r", ARM), tmp_path / "r.png"
    (folder / "robot.toml").write_text('name = "arm"')
    ran = shell("check", folder, "--plot", plot)
    assert ran.status == 2
    assert plot.read_bytes().startswith(PNG)


def test_without_an_mjcf_there_is_no_picture(shell: Windup, tmp_path: Path) -> None:
    folder, plot = write_shape(tmp_path / "r", ARM), tmp_path / "r.png"
    (folder / "model.xml").unlink()
    ran = shell("check", folder, "--plot", plot)
    assert ran.status == 2 and not plot.exists()
    assert "error: model.xml: cannot be read: no such file" in ran.err
    assert "no picture: the MJCF cannot be read" in ran.err


@pytest.mark.parametrize("name", ["op3", "so101", "human"])
def test_robots_of_the_package_can_be_checked_by_name(shell: Windup, name: str) -> None:
    assert shell("check", name).status == 0


def test_no_folder_is_one_line(tmp_path: Path) -> None:
    assert "unknown robot 'nowhere'" in refusal(["check", "nowhere"])
