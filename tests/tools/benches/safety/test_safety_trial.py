"""Whole trials, with all their processes. How soon is the bench's business, not a test's."""

import pytest

from windup.robots import load_robot
from windup.tools.benches.safety.attempt import trial, under_way
from windup.tools.benches.safety.moment import Moment
from windup.tools.benches.safety.rows import ROWS
from windup.tools.benches.safety.verdict import judge


@pytest.mark.parametrize(
    ("name", "robot"),
    [
        ("SIGINT", "op3"),
        ("SIGKILL program", "duck"),
        ("SIGSTOP for ever", "op3"),
        ("SIGKILL guardian", "duck"),
        ("SIGKILL program, standard error closed", "duck"),
        ("SIGKILL program, standard error unread", "op3"),
        ("SIGTERM program, guardian", "duck"),
        ("SIGKILL adapter", "op3"),
        ("goes on after Ctrl-C", "duck"),
        ("exits between two calls", "op3"),
        ("SIGINT in a loop over ticks", "op3"),
        ("loop over ticks blocks 0.3 s", "duck"),
        ("loop over ticks raises", "duck"),
    ],
)
def test_somebody_switches_the_robot_off(name: str, robot: str) -> None:
    row = next(row for row in ROWS if row.name == name)
    with trial(robot, row, Moment("standing", 0.1)) as running:
        under_way(running)
        verdict = judge(running, row, load_robot(robot), row.carry_out(running))
    assert verdict.status in row.status
    assert verdict.found == row.end
