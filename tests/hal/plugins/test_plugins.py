import sys
from pathlib import Path

import pytest

from tests.added.install import install
from windup.hal.errors import PluginError
from windup.hal.plugins.plugins import Plugins

GROUP = "windup.tests"


def whole_number(name: str, found: object) -> int:
    if not isinstance(found, int):
        raise ValueError(f"{name} should be a whole number, not a {type(found).__name__}")
    return found


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


@pytest.fixture
def plugins() -> Plugins[int]:
    return Plugins(GROUP, whole_number, own=lambda: ["ours"])


def warned(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [record.getMessage() for record in caplog.records]


def test_without_other_distributions_there_is_nothing(plugins: Plugins[int]) -> None:
    assert plugins.names() == () and plugins.all() == {}


def test_names_are_known_before_anything_is_imported(folder: Path, plugins: Plugins[int]) -> None:
    install(folder, "lazy", {GROUP: {"b": "lazy_two:B", "a": "lazy_two:A"}},
            {"lazy_two": "A, B = 1, 2"})  # fmt: skip
    assert plugins.names() == ("a", "b")
    assert "lazy_two" not in sys.modules
    assert plugins.load("b") == 2 and plugins.all() == {"a": 1, "b": 2}


def test_a_folder_that_leaves_the_path_takes_its_plugins_with_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, plugins: Plugins[int]
) -> None:
    install(tmp_path, "gone", {GROUP: {"a": "gone_one:A"}}, {"gone_one": "A = 1"})
    with monkeypatch.context() as patch:
        patch.syspath_prepend(tmp_path)
        assert plugins.names() == ("a",)
    assert plugins.names() == ()


BROKEN = {
    "no such module": ("broken_a:X", "", "ModuleNotFoundError: No module named 'broken_a'"),
    "no such attribute": (
        "broken_b:X",
        "Y = 1",
        "AttributeError: module 'broken_b' has no attribute 'X'",
    ),
    "a bug": ("broken_c:X", "raise RuntimeError('one\\n  two')", "RuntimeError: one two"),
    "an exit": ("broken_d:X", "raise SystemExit(3)", "SystemExit: 3"),
    "a wrong type": ("broken_e:X", "X = 'text'", "bad should be a whole number, not a str"),
}


@pytest.mark.parametrize(("value", "text", "why"), BROKEN.values(), ids=BROKEN)
def test_a_broken_entry_point_is_one_line_that_names_its_distribution(
    value: str,
    text: str,
    why: str,
    folder: Path,
    plugins: Plugins[int],
    caplog: pytest.LogCaptureFixture,
) -> None:
    modules = {value.split(":")[0]: text} if text else {}
    install(folder, "broken-thing", {GROUP: {"bad": value, "good": "good_one:G"}},
            {**modules, "good_one": "G = 1"})  # fmt: skip
    line = f"broken-thing 1.0: entry point bad = {value} of {GROUP}: {why}"
    with pytest.raises(PluginError) as caught:
        plugins.load("bad")
    assert str(caught.value) == line
    assert plugins.all() == plugins.all() == {"good": 1}
    assert warned(caplog) == [line]


def test_a_bug_in_the_object_s_own_code_is_said_as_one(folder: Path) -> None:
    install(folder, "buggy", {GROUP: {"a": "buggy_one:A"}}, {"buggy_one": "A = {}"})
    plugins: Plugins[object] = Plugins(GROUP, lambda name, found: vars(found)[name])
    with pytest.raises(PluginError, match=r"^buggy 1\.0: entry point a = .*: TypeError: vars\(\)"):
        plugins.load("a")


def test_a_name_of_windup_or_of_another_distribution_is_not_taken(
    folder: Path, plugins: Plugins[int], caplog: pytest.LogCaptureFixture
) -> None:
    install(folder, "first", {GROUP: {"ours": "n:A", "theirs": "taken_one:A"}},
            {"taken_one": "A = 1"})  # fmt: skip
    install(folder, "second", {GROUP: {"theirs": "n:B"}})
    assert plugins.all() == {"theirs": 1}
    assert warned(caplog) == [
        f"first 1.0: entry point ours = n:A of {GROUP}: Windup has this name itself; "
        "choose another",
        f"second 1.0: entry point theirs = n:B of {GROUP}: first 1.0 has this name too, "
        "and is used",
    ]


def test_malformed_metadata_of_one_distribution_hides_no_other(
    folder: Path, plugins: Plugins[int], caplog: pytest.LogCaptureFixture
) -> None:
    install(folder, "malformed", f"[{GROUP}]\nnot an entry point\n")
    install(folder, "sound", {GROUP: {"a": "sound_one:A"}}, {"sound_one": "A = 1"})
    assert plugins.all() == {"a": 1}
    assert len(warned(caplog)) == 1
    assert warned(caplog)[0].startswith("malformed 1.0: its entry_points.txt cannot be read: ")
