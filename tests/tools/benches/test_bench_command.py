"""`windup bench`: who gets a robot, and whose JSON names one."""

from typing import Any

import pytest

from tests.tools.conftest import Windup
from windup.tools.benches import bench


def measure(*names: str, **options: Any) -> dict[str, Any]:
    return {"given": list(names), "met": True}


@pytest.mark.parametrize("what", ["startup", "bus"])
def test_a_bench_without_a_robot_names_none(
    shell: Windup, monkeypatch: pytest.MonkeyPatch, what: str
) -> None:
    monkeypatch.setattr(bench, f"measure_{what}", measure)
    ran = shell("bench", what, "--json", "-")
    assert ran.status == 0 and ran.json["given"] == []
    assert "robot" not in ran.json


def test_the_bench_of_faults_names_no_robot(shell: Windup, monkeypatch: pytest.MonkeyPatch) -> None:
    result = {"cells": [], "reads": 1, "minutes": 0.0, "met": True}
    monkeypatch.setattr(bench, "measure_faults", lambda reads, seed: result)
    ran = shell("bench", "faults", "--json", "-")
    assert ran.status == 0 and "robot" not in ran.json


def test_a_bench_of_a_robot_names_it(shell: Windup, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench, "measure_tick", measure)
    assert shell("bench", "tick", "--json", "-").json["robot"] == "op3"
    ran = shell("bench", "tick", "--robot", "duck", "--json", "-")
    assert (ran.json["robot"], ran.json["given"]) == ("duck", ["duck"])
