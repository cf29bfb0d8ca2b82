from pathlib import Path

import pytest

from windup.hal.small_file import MOST, read_small


def test_a_file_is_read_whole(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"x" * MOST)
    assert len(read_small(path)) == MOST


def test_a_file_that_is_too_long_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "file"
    with path.open("wb") as file:
        file.truncate(10 * MOST)
    with pytest.raises(OSError, match="longer than 4 MB"):
        read_small(path)


def test_a_device_is_refused_without_being_opened() -> None:
    with pytest.raises(OSError, match="this is a device, not a file"):
        read_small(Path("/dev/zero"))
