import os
from pathlib import Path

import pytest

from windup.hal.errors import OutputError, UsageError
from windup.tools.terminal.writing import check_folder, check_writable, writing


def test_what_can_be_written_is_not_complained_about(tmp_path: Path) -> None:
    check_writable(tmp_path / "new.json", None, Path("-"), Path("/dev/full"))
    (tmp_path / "old.json").write_text("")
    check_writable(tmp_path / "old.json")
    check_folder(tmp_path)
    check_folder(tmp_path / "new")


def test_a_folder_is_no_file(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"cannot be written: this is a folder, not a file"):
        check_writable(tmp_path)


def test_a_file_is_no_folder(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(UsageError, match=r"cannot be written: this is a file, not a folder"):
        check_folder(tmp_path / "file")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("none/result.json", "there is no folder "),
        ("x" * 300, "File name too long"),
        ("loop", "Too many levels of symbolic links"),
    ],
)
def test_a_path_that_leads_nowhere_is_told_first(tmp_path: Path, name: str, said: str) -> None:
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    with pytest.raises(UsageError, match=said):
        check_writable(tmp_path / name)


def test_permissions_are_told_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "old.json").write_text("")
    monkeypatch.setattr(os, "access", lambda *_: False)  # root may write anything
    for check, target in (
        (check_writable, "new.json"),
        (check_writable, "old.json"),
        (check_folder, "."),
    ):
        with pytest.raises(UsageError, match="permission denied"):
            check(tmp_path / target)


def test_closed_standard_output_is_told_first(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdout", None)
    with pytest.raises(UsageError, match="standard output cannot be written: it is closed"):
        check_writable(Path("-"))


def test_what_fails_in_the_end_is_one_line_and_status_1() -> None:
    full, said = Path("/dev/full"), r"^/dev/full cannot be written: No space left"
    with pytest.raises(OutputError, match=said) as failed, writing(full):
        full.write_text("figures")
    assert failed.value.exit_status == 1
