import os
from pathlib import Path

import pytest

from windup.hal.errors import UsageError
from windup.hal.stopping.folder import folders_to_search, other_users, private_folder


def test_the_folder_depends_on_the_user_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path / "elsewhere"))
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    folder = private_folder(tmp_path)
    assert folder == tmp_path / f"windup-{os.getuid()}"
    assert folder.stat().st_mode & 0o777 == 0o700
    assert private_folder(tmp_path) == folder


def test_a_folder_that_others_may_enter_is_refused_with_the_remedy(tmp_path: Path) -> None:
    folder = private_folder(tmp_path)
    folder.chmod(0o755)
    with pytest.raises(UsageError, match="is open to other users; remove it"):
        private_folder(tmp_path)
    assert list(folders_to_search(tmp_path)) == []


def test_a_link_in_its_place_is_refused(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir(mode=0o700)
    (tmp_path / f"windup-{os.getuid()}").symlink_to(tmp_path / "mine")
    with pytest.raises(UsageError, match="is no folder; remove it"):
        private_folder(tmp_path)


def test_a_file_in_its_place_is_refused(tmp_path: Path) -> None:
    (tmp_path / f"windup-{os.getuid()}").touch()
    with pytest.raises(UsageError, match="cannot be made"):
        private_folder(tmp_path / "missing")
    with pytest.raises(UsageError, match="File exists"):
        private_folder(tmp_path)


def test_only_folders_that_belong_to_the_user_in_their_name_count(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / f"windup-{os.getuid() + 1}").mkdir()
    assert other_users(tmp_path) == []
    own = private_folder(tmp_path)
    assert list(folders_to_search(tmp_path)) == [own]
    monkeypatch.setattr("os.getuid", lambda: own.stat().st_uid + 1)
    assert other_users(tmp_path) == [own.stat().st_uid]
