import io
from pathlib import Path

import pytest
from rich.console import Console

from tests.shapes import ARM, write_shape
from windup.robots import load_robot
from windup.tools.checking.travel import travel_rows, travel_table


def test_a_joint_has_its_limits_in_degrees_and_in_counts(tmp_path: Path) -> None:
    folder = write_shape(tmp_path / "r", ARM)
    file = folder / "robot.toml"
    file.write_text(file.read_text().replace("id = 1,", "id = 1, sign = -1, zero = 1500,"))
    first, second, *_ = travel_rows(load_robot(folder))
    assert first["counts"] == [2478, 522] and first["travel"] == [0, 4095]
    assert (first["servo"], first["bus"], first["id"]) == ("XM430-W350", "body", 1)
    assert second["upper_deg"] == pytest.approx(85.94, abs=0.01)


def test_ideal_joints_have_no_counts() -> None:
    row = travel_rows(load_robot("human"))[0]
    assert row["servo"] is None and row["counts"] is None


@pytest.mark.parametrize("name", ["op3", "human"])
def test_the_table_has_a_line_a_joint(name: str) -> None:
    console = Console(width=120, record=True, file=io.StringIO())
    rows = travel_rows(load_robot(name))
    console.print(travel_table(rows))
    text = console.export_text()
    assert all(row["joint"] in text for row in rows)
