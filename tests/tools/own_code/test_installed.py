"""A package adds a behaviour by an entry point, without a change of Windup."""

from pathlib import Path

import pytest

from tests.tools.conftest import Windup, refusal
from windup.tools.own_code.installed import installed_behaviours


def install(folder: Path, monkeypatch: pytest.MonkeyPatch, value: str) -> None:
    """Let a package be installed whose only behaviour `nod` is at `value`."""
    info = folder / "windup_nod-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: windup-nod\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[windup.behaviours]\nnod = {value}\n")
    monkeypatch.syspath_prepend(folder)


@pytest.fixture
def nod(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    install(tmp_path, monkeypatch, "tests.tools.own_code.nodding_package:Nod")


@pytest.mark.usefixtures("nod")
def test_a_behaviour_of_a_package_runs_with_its_own_options(shell: Windup) -> None:
    ran = shell("run", "op3", "nod", "--times", "1", "--angle", "12", "--json", "-")
    assert ran.status == 0, ran.err
    assert ran.json["options"] == {"joint": "head_tilt", "angle": 12.0, "times": 1}
    assert (ran.json["reason"], ran.json["fell"]) == ("done", False)
    assert ran.json["sim_time_s"] == pytest.approx(1.0, abs=0.02)


@pytest.mark.usefixtures("nod")
def test_its_help_has_its_options_with_their_docstrings(shell: Windup) -> None:
    text = " ".join(shell("run", "op3", "nod", "--help").out.split())
    assert "Nod, and say how it went." in text
    assert "--angle FLOAT" in text and "How far, degrees." in text and "--port" in text


@pytest.mark.usefixtures("nod")
def test_several_seeds_are_rows_and_counted(shell: Windup) -> None:
    ran = shell("run", "op3", "nod", "--times", "1", "--seeds", "2", "--json", "-")
    assert [row["seed"] for row in ran.json["rows"]] == [0, 1]
    assert ran.err.splitlines()[-1] == "2 of 2 seeds nodded"


@pytest.mark.usefixtures("nod")
def test_what_its_options_cannot_be_is_refused_before_anything_moves() -> None:
    assert "unknown joint 'head_tlit'; did you mean 'head_tilt'?" in refusal(
        ["run", "op3", "nod", "--joint", "head_tlit"]
    )


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("nowhere.nod:Nod", "cannot be loaded: ModuleNotFoundError: No module named 'nowhere'"),
        ("math:pi", "math:pi is a float; it should be a subclass of windup.Behaviour"),
    ],
)
def test_a_package_that_is_wrong_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, value: str, said: str
) -> None:
    install(tmp_path, monkeypatch, value)
    line = refusal(["run", "op3", "nod"])
    assert "behaviour 'nod' of windup-nod" in line
    assert said in line


def test_no_package_brings_one_by_itself() -> None:
    assert "nod" not in installed_behaviours()
