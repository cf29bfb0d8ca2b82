from pathlib import Path

import pytest

from tests.tools.conftest import Windup, refusal
from windup.hal.errors import OutputError, UsageError
from windup.tools.terminal.picture import check_picture, load_pyplot, save_picture


def test_a_picture_that_can_be_drawn_is_not_complained_about(tmp_path: Path) -> None:
    check_picture(None)
    check_picture(tmp_path / "walk.PNG")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("walk.foo", r"walk.foo: name it .png, .pdf, .svg, .jpg, .jpeg or .webp"),
        ("walk", r"walk: name it .png"),
        ("none/walk.png", "there is no folder"),
        ("folder.png", "this is a folder"),
    ],
)
def test_a_picture_that_cannot_be_drawn_is_refused_first(
    tmp_path: Path, name: str, said: str
) -> None:
    (tmp_path / "folder.png").mkdir()
    with pytest.raises(UsageError, match=said):
        check_picture(tmp_path / name)


def test_a_missing_matplotlib_is_told_first(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("windup.tools.terminal.picture.find_spec", lambda name: None)
    with pytest.raises(UsageError, match=r"--plot needs matplotlib: pip install"):
        check_picture(Path("walk.png"))


def test_a_disk_that_is_full_in_the_end_is_an_error_of_ours(tmp_path: Path) -> None:
    (tmp_path / "full.png").symlink_to("/dev/full")
    pyplot = load_pyplot()
    figure = pyplot.figure()
    with pytest.raises(OutputError, match=r"full\.png cannot be written: No space left"):
        save_picture(tmp_path / "full.png", figure)
    pyplot.close(figure)


@pytest.mark.usefixtures("nothing_opens")
@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("walk op3 --plot a.foo", "--plot a.foo: name it"),
        ("walk op3 --plot a.png --seeds 2", "--plot draws one walk: leave it or --seeds away"),
        ("push op3 --impulse 1 --plot a.png", "--plot draws an envelope: give --envelope"),
        ("play op3 wave --plot a.png", "unknown option --plot"),
    ],
)
def test_a_plot_that_nothing_would_draw_is_refused(line: str, said: str) -> None:
    assert said in refusal(line.split())


def test_a_picture_that_is_lost_takes_nothing_along(shell: Windup, tmp_path: Path) -> None:
    full = tmp_path / "full.png"
    full.symlink_to("/dev/full")
    ran = shell("walk", "op3", "--steps", 1, "--open-loop", "--plot", full, "--json", "-")
    assert (ran.status, ran.json["steps"]) == (1, 1)
    assert f"windup: {full} cannot be written: No space left" in ran.err
    assert "op3 walked 1 steps" in ran.err
