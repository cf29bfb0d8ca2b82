"""An emulator says that it serves once it does: its loop has run, slow first passes included."""

import pytest

from windup.sim_twin.wire import parse_address
from windup.sim_twin.wire.serve import emulate as served
from windup.sim_twin.wire.serve.emulate import Emulator, emulate


def test_its_loop_runs_before_it_says_that_it_is_ready(monkeypatch: pytest.MonkeyPatch) -> None:
    order: list[str] = []
    steps: list[float] = []

    def ready(emulator: Emulator) -> None:
        order.append("ready")
        steps.append(emulator.world.physics_time)
        emulator.stop()

    monkeypatch.setattr(served, "_set_real_time", lambda: order.append("real time"))
    emulate(parse_address("twin://bench?servos=STS3215:1-2"), tcp=0, on_ready=ready)
    assert order == ["real time", "ready"]
    assert steps[0] > 0.0
