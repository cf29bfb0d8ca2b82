"""Doubts about one's own robot: one line, where it is first used, and no more."""

from pathlib import Path

import pytest

from tests.shapes import ARM, write_shape
from tests.tools.conftest import Windup
from windup import Robot
from windup.robots.inspection import doubt_once
from windup.tools.testing.servo_bus import ServoBus


@pytest.fixture
def doubtful(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Write an arm without armature, which nobody has looked at."""
    monkeypatch.setattr(doubt_once, "_looked_at", set())
    folder = write_shape(tmp_path / "my arm", ARM)
    model = folder / "model.xml"
    model.write_text(model.read_text().replace('armature="0.01"', ""))
    return folder


def test_the_first_command_points_to_the_doubts(
    shell: Windup, doubtful: Path, caplog: pytest.LogCaptureFixture
) -> None:
    for _ in range(2):
        assert shell("stand", doubtful, "--seconds", "0.02").status == 0
    assert caplog.messages == [f"1 thing is doubtful about arm: run `windup check '{doubtful}'`"]


@pytest.mark.parametrize("wired", [False, True])
def test_so_does_the_first_use_in_python(
    wired: bool, doubtful: Path, caplog: pytest.LogCaptureFixture
) -> None:
    if wired:
        with ServoBus(str(doubtful)) as bus:
            bus.robot()
    else:
        Robot.open(str(doubtful)).close()
    assert sum("doubtful" in message for message in caplog.messages) == 1


def test_nothing_is_said_of_the_robots_of_the_package(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(doubt_once, "_looked_at", set())
    Robot.open("human").close()
    assert caplog.messages == []
