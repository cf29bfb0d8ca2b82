"""What starting costs, from times that are made up."""

from collections.abc import Callable
from itertools import cycle
from subprocess import CalledProcessError

import pytest

from windup.tools.benches import startup
from windup.tools.benches.startup import BASE, WAYS, measure_startup


def pretend(monkeypatch: pytest.MonkeyPatch, seconds: Callable[[tuple[str, ...]], float]) -> None:
    """Let each start take as long as `seconds` says."""
    monkeypatch.setattr(startup, "_seconds", lambda arguments, folder: seconds(arguments))


def test_the_best_round_of_each_way_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    noise = cycle((0.3, 0.0, 0.5))
    pretend(monkeypatch, lambda arguments: 0.1 + next(noise))
    result = measure_startup(times=6)
    assert result["numpy_ms"] == pytest.approx(100.0)
    assert all(value == 1.0 for name, value in result.items() if name in WAYS)
    assert result["met"] is True


def test_one_way_that_is_too_slow_is_not_met(monkeypatch: pytest.MonkeyPatch) -> None:
    slow = WAYS["windup --help"]
    pretend(monkeypatch, lambda arguments: 0.26 if arguments == slow.arguments else 0.1)
    result = measure_startup(times=1)
    assert result["windup --help"] == 2.6 and result["met"] is False
    pretend(monkeypatch, lambda arguments: 0.25 if arguments == slow.arguments else 0.1)
    assert measure_startup(times=1)["met"] is True


def test_pytest_is_compared_with_itself_without_the_plugin(monkeypatch: pytest.MonkeyPatch) -> None:
    base = WAYS[BASE].arguments
    pretend(monkeypatch, lambda arguments: 0.1 if arguments == base else 1.0)
    assert measure_startup(times=1)["pytest with the plugin"] == 1.0


def test_an_interpreter_that_fails_is_an_error() -> None:
    with pytest.raises(CalledProcessError):
        startup._seconds(("-c", "raise SystemExit(3)"), ".")
