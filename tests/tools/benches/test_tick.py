"""The arithmetic of `windup bench tick`; how long a tick takes is no matter of tests."""

import gc

import pytest

from windup.control.loop import LoopReport
from windup.tools.benches.tick import TickTimes


def test_a_behaviour_is_measured_in_bare_steps_without_collecting_garbage() -> None:
    enabled = []

    def run() -> LoopReport:
        enabled.append(gc.isenabled())
        return LoopReport(tick=[0.001] * 99 + [0.003])

    times = TickTimes()
    times.measure("op3_walking", run)
    found = times.conclude()
    assert enabled == [False] and gc.isenabled()
    assert found["op3_walking_p50_ms"] == pytest.approx(1.0)
    assert found["bare_step_ms"] > 0.0
    multiple = found["op3_walking_p99_ms"] / found["bare_step_ms"]
    assert found["op3_walking_p99_steps"] == pytest.approx(multiple, abs=0.006)
