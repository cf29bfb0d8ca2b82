"""Odd command lines on broken robots: each is answered in words, whatever it was."""

import random
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from windup.robots import load_robot
from windup.tools.benches.fuzz.broken_mjcf import broken_mjcf
from windup.tools.benches.fuzz.broken_toml import MISTAKES, broken_toml
from windup.tools.benches.fuzz.odd_line import odd_line
from windup.tools.benches.fuzz.trial import Trial, odd_run
from windup.tools.cli import run

OP3 = load_robot("op3").folder


@given(seed=st.integers(0, 10**9))
@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_an_odd_run_ends_with_a_status_and_without_a_traceback(seed: int) -> None:
    trial = odd_run(run, seed, ("op3", "duck", "human", "robobird"))
    assert trial.fault == "", f"windup {' '.join(trial.words)}\n{trial.trace}"


def test_a_seed_makes_the_same_mistakes_again() -> None:
    toml, mjcf = (OP3 / "robot.toml").read_text(), (OP3 / "model.xml").read_text()
    for seed in range(20):
        rng, again = random.Random(seed), random.Random(seed)
        assert broken_toml(rng, toml) == broken_toml(again, toml)
        assert broken_mjcf(rng, mjcf) == broken_mjcf(again, mjcf)
        assert odd_line(rng, "op3", Path("x")) == odd_line(again, "op3", Path("x"))


def test_every_kind_of_mistake_changes_a_file() -> None:
    toml = (OP3 / "robot.toml").read_text()
    for mistake in MISTAKES:
        assert any(mistake(random.Random(seed), toml) != toml for seed in range(5)), mistake


@pytest.mark.parametrize(
    ("status", "trace", "memory", "fault"),
    [
        (2, "", 10, ""),
        (None, "Traceback\n  x\nKeyError: 'a'\n", 10, "KeyError: 'a'"),
        (7, "", 10, "exit status 7"),
        (0, "", 3 << 30, "3072 MB"),
    ],
)
def test_what_is_a_fault(status: int | None, trace: str, memory: int, fault: str) -> None:
    assert Trial(0, (), status, trace, False, memory).fault == fault
