"""The scripts in `examples` do what they are for."""

import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from windup.tools import cli

EXAMPLES = Path(__file__).parents[2] / "examples"
PLUGIN = "windup.tools.testing.pytest_plugin"


def load(name: str) -> dict[str, Any]:
    return runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name=name)


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.py")), ids=lambda path: path.name)
def test_an_example_is_short(path: Path) -> None:
    assert 30 <= len(path.read_text().splitlines()) <= 65


def test_own_controller_sways_and_stands() -> None:
    width, fallen = load("own_controller")["main"]()
    assert width > 0.01 and not fallen


@pytest.mark.parametrize("name", ["shoulder_sine", "own_controller"])
def test_controllers_run_from_the_command_line(name: str) -> None:
    file = str(EXAMPLES / f"{name}.py")
    assert cli.run(["run", "op3", file, "--seconds", "1"]) == 0


def test_live_speed_follows_what_is_commanded() -> None:
    speeds = load("live_speed")["main"]()
    slow, fast = (np.mean([speeds[n] for n in steps]) for steps in (range(12, 20), range(32, 40)))
    assert slow == pytest.approx(0.1, abs=0.04) and fast == pytest.approx(0.25, abs=0.05)
    assert speeds[70] == pytest.approx(0.0, abs=0.05)


def test_push_and_step_stays_up_with_steps_alone() -> None:
    results = load("push_and_step")["main"]()
    assert not results["hold"]["survived"] and results["predictive"]["survived"]
    assert results["predictive"]["steps"] > 0


def test_log_and_plot_writes_a_log_and_pictures(tmp_path: Path) -> None:
    run = load("log_and_plot")["main"](tmp_path)
    kept = np.load(tmp_path / "walk.npz")
    assert np.array_equal(kept["position"], run.arrays["position"]) and len(kept["time"]) > 100
    for name in ("walk.png", "feet.png"):
        assert (tmp_path / name).stat().st_size > 10_000


@pytest.mark.parametrize("port", [None, "twin://op3"])
def test_shoulders_swings_them_on_the_twin_and_through_servos(port: str | None) -> None:
    report = load("shoulders")["main"](port)
    assert (report.reason, report.fallen) == ("done", False)
    shoulder = report.arrays["position"][:, report.data.joints.index("l_sho_pitch")]
    assert np.ptp(shoulder) == pytest.approx(0.8, abs=0.1)


def test_own_robot_stands_and_walks() -> None:
    stands, speed = load("own_robot")["main"](steps=20)
    assert stands and speed is not None and speed == pytest.approx(0.1, abs=0.04)


def test_servo_tests_pass(pytester: pytest.Pytester) -> None:
    pytester.makepyfile((EXAMPLES / "test_servos.py").read_text())
    pytester.runpytest("-p", PLUGIN).assert_outcomes(passed=3)
