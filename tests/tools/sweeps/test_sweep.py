"""Sweeps of a command that costs nothing."""

import csv
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import pytest
import tyro

from windup.hal.errors import HardwareError, UsageError
from windup.tools import cli
from windup.tools.command_line.table import COMMANDS, Entry
from windup.tools.sweeps.sweep_grid import parse_axis, points
from windup.tools.sweeps.sweep_table import CsvTable, open_table
from windup.tools.terminal.command import Command


@dataclass(frozen=True, kw_only=True)
class Fake(Command):
    robot: Annotated[str, tyro.conf.Positional]
    gain: float = 1.0
    servo: bool = True
    rv: tuple[str, ...] = ()
    port: str | None = None
    seed: int = 0
    seeds: int | None = None
    json: Path | None = None

    def run(self) -> int:
        if self.gain > 2.0:
            raise HardwareError("too\nmuch")
        assert self.json is not None
        result = {
            "schema": 1,
            "command": "fake",
            "seed": self.seed,
            "gain": 10.0 * self.gain,
            "tick_ms": {"p50": 0.5},
            "regulation": [{"name": "up", "mean": 0.25 * self.seed}],
            "servo_was": self.servo,
            "rvs": list(self.rv),
        }
        self.json.write_text(json.dumps(result))
        return 1 if self.seed else 0


class FakeEntry(Entry):
    def load(self) -> type:
        return Fake


@pytest.fixture(autouse=True)
def fake_command(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(COMMANDS, "fake", FakeEntry("", "Fake", ""))
    monkeypatch.chdir(tmp_path)


def sweep(*arguments: str) -> int:
    return cli.run(["sweep", "fake", "me", *arguments])


def read(path: str) -> list[dict[str, str]]:
    with Path(path).open(newline="") as file:
        return list(csv.DictReader(file))


def test_a_row_has_parameters_seed_and_flat_results() -> None:
    assert sweep("--grid", "gain=0.5,1", "--seeds", "2", "--out", "a.csv") == 0
    rows = sorted(read("a.csv"), key=lambda row: (row["gain"], row["seed"]))
    assert [(row["gain"], row["seed"]) for row in rows] == [
        ("0.5", "0"),
        ("0.5", "1"),
        ("1", "0"),
        ("1", "1"),
    ]
    row = rows[1]
    assert row["command"] == "fake me"
    assert row["exit_status"] == "1"
    assert row["error"] == ""
    assert row["tick_ms.p50"] == "0.5"
    assert row["regulation.up.mean"] == "0.25"
    assert row["result.gain"] == "5.0"  # the result's own gain, beside the parameter


def test_switches_and_options_of_several_values_can_be_swept() -> None:
    grid = ("--grid", "servo=true,false", "--grid", "rv=up,up+xcom")
    assert sweep(*grid, "--out", "a.csv") == 0
    seen = {(row["servo_was"], row["rvs.0"], row["rvs.1"]) for row in read("a.csv")}
    assert seen == {(servo, "up", other) for servo in ("true", "false") for other in ("", "xcom")}


def test_a_second_sweep_runs_only_what_is_missing(capfd: pytest.CaptureFixture[str]) -> None:
    assert sweep("--grid", "gain=0.5", "--out", "a.csv") == 0
    before = Path("a.csv").read_text()
    assert sweep("--grid", "gain=0.5,1", "--seeds", "2", "--out", "a.csv") == 0
    assert "4 runs, 1 of them" in capfd.readouterr().err
    assert len(read("a.csv")) == 4
    assert Path("a.csv").read_text().startswith(before)
    whole = Path("a.csv").read_text()
    assert sweep("--grid", "gain=0.5,1", "--seeds", "2", "--out", "a.csv") == 0
    assert Path("a.csv").read_text() == whole


def test_a_torn_last_row_is_run_again() -> None:
    assert sweep("--seeds", "2", "--jobs", "1", "--out", "a.csv") == 0
    text = Path("a.csv").read_text()
    Path("a.csv").write_text(text[:-7])
    assert sweep("--seeds", "2", "--out", "a.csv") == 0
    assert Path("a.csv").read_text() == text


def test_an_error_is_a_row_and_the_others_go_on() -> None:
    assert sweep("--grid", "gain=3,1", "--jobs", "1", "--out", "a.csv") == 1
    rows = {row["gain"]: row for row in read("a.csv")}
    assert rows["3"]["error"] == "too much"
    assert rows["3"]["exit_status"] == "3"
    assert rows["1"]["error"] == ""


def test_random_points_lie_in_their_range_and_a_sweep_can_grow() -> None:
    few = points([parse_axis("gain=0:2"), parse_axis("rv=a,b")], 3, seed=1)
    many = points([parse_axis("gain=0:2"), parse_axis("rv=a,b")], 5, seed=1)
    assert many[:3] == few
    assert all(0.0 <= float(point["gain"]) <= 2.0 and point["rv"] in "ab" for point in many)


def test_parquet_keeps_the_same_rows() -> None:
    pytest.importorskip("polars")
    assert sweep("--grid", "gain=0.5,3", "--seeds", "2", "--out", "a.parquet") == 1
    assert sweep("--grid", "gain=0.5,3", "--seeds", "3", "--out", "a.parquet") == 1
    rows = open_table(Path("a.parquet")).rows
    keys = sorted((row["gain"], row["seed"]) for row in rows)
    assert keys == [(gain, seed) for gain in (0.5, 3.0) for seed in range(3)]


def test_a_new_column_keeps_the_old_rows(tmp_path: Path) -> None:
    table = CsvTable(tmp_path / "a.csv")
    table.append({"command": "x", "seed": 0, "a": 1})
    table.append({"command": "x", "seed": 1, "b": "two, three"})
    again: list[dict[str, Any]] = CsvTable(tmp_path / "a.csv").rows
    assert again == [
        {"command": "x", "seed": 0, "a": 1, "b": None},
        {"command": "x", "seed": 1, "a": None, "b": "two, three"},
    ]


@pytest.mark.parametrize(
    "arguments",
    [
        ("--grid", "gain"),
        ("--grid", "gain=1:"),
        ("--grid", "gain=2:1:3"),
        ("--grid", "gain=0:1:1"),
        ("--grid", "gain=1,,2"),
        ("--grid", "gain=0:1"),
        ("--grid", "gian=1"),
        ("--grid", "robot=you"),
        ("--grid", "gain=one"),
        ("--grid", "servo=maybe"),
        ("--grid", "gain=1", "--grid", "gain=2"),
        ("--grid", "port=/dev/ttyUSB0"),
        ("--random", "3"),
        ("--seeds", "0"),
        ("--jobs", "0"),
        ("--json", "x.json"),
    ],
)
def test_bad_input_is_one_line_and_status_2(
    arguments: tuple[str, ...], capfd: pytest.CaptureFixture[str]
) -> None:
    assert sweep(*arguments, "--out", "a.csv") == 2
    said = capfd.readouterr().err.strip().splitlines()
    assert len([line for line in said if line.startswith("windup: ")]) == 1
    assert len(said) <= 2  # --jobs is read after the count of runs has been said
    assert not Path("a.csv").exists()


def test_a_foreign_file_is_left_alone() -> None:
    Path("a.csv").write_text("x,y\n1,2\n")
    with pytest.raises(UsageError, match="no sweep's"):
        open_table(Path("a.csv"))
    assert sweep("--out", "a.csv") == 2
    assert sweep("--out", "a.txt") == 2
    assert Path("a.csv").read_text() == "x,y\n1,2\n"
