"""What is found after the adapter of a robot has died."""

from types import SimpleNamespace
from typing import Any, cast

import pytest

from windup.robots import load_robot
from windup.tools.benches.safety import verdict
from windup.tools.benches.safety.rows import ROWS


@pytest.mark.parametrize(
    ("driven", "watched", "found"),
    [(3, True, "unknown"), (3, False, "unattended"), (0, False, "unknown")],
)
def test_who_is_left_matters_only_where_torque_was_on(
    driven: int, watched: bool, found: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(verdict, "_watched", lambda *_: watched)
    row = next(row for row in ROWS if row.end == "unknown")
    trial = cast(Any, SimpleNamespace(journal=SimpleNamespace(driven=driven)))
    assert verdict._found(trial, row, load_robot("op3")) == found
