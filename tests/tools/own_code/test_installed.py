"""A package adds a behaviour by an entry point, without a change of Windup."""

from pathlib import Path

import pytest

from tests.added.install import install
from tests.tools.conftest import Windup, refusal
from tests.tools.own_code.nodding_package import Nod, Nodder
from windup.tools.own_code.installed import INSTALLED


def add(folder: Path, monkeypatch: pytest.MonkeyPatch, value: str) -> None:
    """Let a distribution be installed whose only behaviour `nod` is at `value`."""
    install(folder, "windup_nod", {"windup.behaviours": {"nod": value}})
    monkeypatch.syspath_prepend(folder)


@pytest.fixture
def nod(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    add(tmp_path, monkeypatch, "tests.tools.own_code.nodding_package:Nod")


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
def test_several_seeds_run_in_processes_where_the_behaviour_wants_so(
    shell: Windup, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Nod, "run_parallel", True)
    ran = shell("run", "op3", "nod", "--times", "1", "--seeds", "2", "--json", "-")
    assert [row["seed"] for row in ran.json["rows"]] == [0, 1], ran.err
    assert ran.json["rows"][1]["options"]["times"] == 1


@pytest.mark.usefixtures("nod")
def test_an_exception_in_its_code_ends_the_command_in_one_line(
    shell: Windup, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Nodder, "step", lambda *_: dict[str, float]()["angle"])
    ran = shell("run", "op3", "nod")
    assert ran.status == 1
    assert ran.err.splitlines()[-1].startswith("windup: the controller failed: KeyError: 'angle'")


@pytest.mark.usefixtures("nod")
def test_what_its_options_cannot_be_is_refused_before_anything_moves() -> None:
    assert "unknown joint 'head_tlit'; did you mean 'head_tilt'?" in refusal(
        ["run", "op3", "nod", "--joint", "head_tlit"]
    )


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("nowhere.nod:Nod", "ModuleNotFoundError: No module named 'nowhere'"),
        ("math:pi", "it should be a windup.Behaviour, not a float"),
    ],
)
def test_a_package_that_is_wrong_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, value: str, said: str
) -> None:
    add(tmp_path, monkeypatch, value)
    line = refusal(["run", "op3", "nod"])
    assert f"entry point nod = {value} of windup.behaviours: {said}" in line


def test_no_package_brings_one_by_itself() -> None:
    assert INSTALLED.names() == ()
