import os
from pathlib import Path

import pytest

from windup.hal.errors import UsageError
from windup.tools.remote.place import Note, Place, RuntimeLock

NOTE = Note(pid=os.getpid(), port="/dev/ttyUSB0", version="0.1.0")


@pytest.fixture
def place(tmp_path: Path) -> Place:
    return Place("op3", tmp_path / "op3.runtime", tmp_path / "op3.socket")


def test_a_robot_that_is_up_is_known_with_its_process(place: Place) -> None:
    assert place.note() is None
    lock = RuntimeLock(place, NOTE)
    assert place.note() == NOTE
    lock.release()
    assert place.note() is None and list(place.lock.parent.iterdir()) == []


def test_it_cannot_be_up_twice(place: Place) -> None:
    lock = RuntimeLock(place, NOTE)
    with pytest.raises(UsageError) as refused:
        RuntimeLock(place, Note(pid=7))
    assert str(refused.value) == (
        f"op3 is up already, on /dev/ttyUSB0 (process {os.getpid()}): "
        "`windup status op3` shows it, `windup down op3` ends it"
    )
    lock.release()


def test_what_a_dead_runtime_left_is_taken_over(place: Place) -> None:
    place.lock.write_text('{"pid": 7}')
    place.socket.touch()
    assert place.note() is None
    assert "its runtime has died; begin it with `windup up op3` again" in str(place.not_up())
    lock = RuntimeLock(place, NOTE)
    assert place.note() == NOTE and not place.socket.exists()
    lock.release()


def test_a_robot_that_is_not_up_is_told_with_the_remedy(place: Place) -> None:
    said = "op3 is not up; begin it with `windup up op3`, or leave --up away for its twin"
    assert str(place.not_up()) == said


def test_a_place_depends_on_the_name_alone(tmp_path: Path) -> None:
    assert Place.of("my robot", tmp_path) == Place.of("my/robot", tmp_path)._replace(
        robot="my robot"
    )
    with pytest.raises(UsageError, match="the name is too long for a socket"):
        Place.of(100 * "r", tmp_path)


def test_the_robots_of_another_user_are_named_as_such(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    user = tmp_path.stat().st_uid
    (tmp_path / f"windup-{user}").mkdir()
    monkeypatch.setattr("os.getuid", lambda: user + 1)
    place = Place.of("op3", tmp_path / f"windup-{user + 1}")
    assert f"(user {user} uses Windup too; the robots of another user are its own)" in str(
        place.not_up()
    )
