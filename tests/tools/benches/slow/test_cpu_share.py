"""A share of a core is written into a control group, which is removed; else the reason is said."""

from pathlib import Path

import pytest

from windup.hal.errors import UsageError
from windup.tools.benches.slow import cpu_share as module
from windup.tools.benches.slow.cpu_share import cpu_share


@pytest.fixture
def groups(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Stand-in for the kernel's folder of the CPU controller."""
    monkeypatch.setattr(module, "VERSION_1", tmp_path)
    return tmp_path


def test_the_group_is_removed(groups: Path) -> None:
    with cpu_share(0.35) as processes:
        group = processes.parent
        assert group.parent == groups
        assert (group / "cpu.max").read_text() == "1400 4000"
        (group / "cpu.max").unlink()  # the kernel's files go with their folder
    assert not group.exists()


def test_version_1_has_files_of_its_own(groups: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def with_files(self: Path) -> None:
        make(self)
        (self / "cpu.cfs_period_us").touch()

    make = Path.mkdir
    monkeypatch.setattr(Path, "mkdir", with_files)
    monkeypatch.setattr(module, "PATIENCE", 0.0)
    with cpu_share(0.5) as processes:
        assert (processes.parent / "cpu.cfs_period_us").read_text() == "4000"
        assert (processes.parent / "cpu.cfs_quota_us").read_text() == "2000"


def test_who_may_not_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "VERSION_1", tmp_path / "none")
    monkeypatch.setattr(module, "VERSION_2", tmp_path / "none either")
    wrong = pytest.raises(UsageError, match="No such file or directory; run this bench as root")
    with wrong, cpu_share(0.35):
        raise AssertionError("not reached")
