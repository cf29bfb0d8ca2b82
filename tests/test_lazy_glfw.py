"""A module whose code runs when it is first used."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from windup.hal.lazy_glfw import LazyModule, import_lazily

NAME = "late_example"


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Return the file of a module that is not loaded yet."""
    monkeypatch.syspath_prepend(tmp_path)
    yield tmp_path / f"{NAME}.py"
    sys.modules.pop(NAME, None)


def test_it_is_loaded_by_its_first_attribute(file: Path) -> None:
    file.write_text("answer = 42")
    import_lazily(NAME)
    module = sys.modules[NAME]
    assert isinstance(module, LazyModule)
    assert module.answer == 42
    assert type(module) is not LazyModule


def test_one_that_fails_says_so_each_time_and_not_that_its_attributes_are_missing(
    file: Path,
) -> None:
    file.write_text("raise OSError('no library')")
    import_lazily(NAME)
    module = sys.modules[NAME]
    for _ in range(2):
        with pytest.raises(OSError, match="no library"):
            _ = module.answer
    file.write_text("answer = 420  # the library is there now")
    assert module.answer == 420
