from dataclasses import dataclass

import numpy as np
import pytest

import windup.sim_twin.backend
from windup.control.loop import run_loop
from windup.hal.command import JointCommand
from windup.hal.guard import GuardedBackend, SafetyLimits
from windup.hal.observation import Observation
from windup.robots import load_robot
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.twin import Twin

TICK = 0.008


@dataclass
class Wall:
    """A wall clock that moves when it is told to, or slept on."""

    time: float = 100.0

    def monotonic(self) -> float:
        return self.time

    def sleep_until(self, time: float) -> None:
        self.time = max(self.time, time)


@pytest.fixture
def wall(monkeypatch: pytest.MonkeyPatch) -> Wall:
    wall = Wall()
    monkeypatch.setattr(windup.sim_twin.backend, "wall", wall)
    monkeypatch.setattr(windup.sim_twin.backend, "sleep_until", wall.sleep_until)
    return wall


def backend(paced: bool = True) -> TwinBackend:
    return TwinBackend(Twin(load_robot("op3")), paced=paced)


def test_unpaced_time_stands_while_somebody_computes(wall: Wall) -> None:
    clock = backend(paced=False).clock
    clock.align()
    wall.time += 1.0
    assert clock.now() == 0.0
    clock.wait_until(TICK)
    assert clock.now() == pytest.approx(TICK)
    assert wall.time == 101.0


def test_paced_time_is_the_walls_in_whole_physics_steps(wall: Wall) -> None:
    clock = backend().clock
    wall.time += 5.0  # before a run nothing counts
    assert clock.now() == 0.0
    clock.align()
    wall.time += 0.0019
    assert clock.now() == 0.0
    wall.time += 0.0002
    assert clock.now() == pytest.approx(0.002)


def test_a_paced_wait_ends_at_an_absolute_time(wall: Wall) -> None:
    clock = backend().clock
    clock.align()
    for tick in range(1, 6):
        wall.time += 0.003
        clock.wait_until(tick * TICK)
        assert wall.time == pytest.approx(100.0 + tick * TICK)
        assert clock.twin.time == pytest.approx(tick * TICK)


@dataclass
class Slow:
    """Holds still; takes 20 ms for its fourth tick."""

    wall: Wall
    ticks: int = 0

    def reset(self, observation: Observation) -> None:
        self.hold = observation.joints.position

    def step(self, observation: Observation, dt: float) -> JointCommand:
        self.ticks += 1
        self.wall.time += 0.020 if self.ticks == 4 else 0.001
        return JointCommand.hold(load_robot("op3").joints, self.hold)


def test_a_paced_loop_counts_the_ticks_that_were_missed(wall: Wall) -> None:
    twin = backend()
    guard = GuardedBackend(twin, SafetyLimits.of(twin.joints))
    twin.clock.align()
    seen: list[float] = []

    def until(observation: Observation) -> str | None:
        seen.append(observation.time)
        return "done" if observation.time > 0.06 else None

    report = run_loop(guard, Slow(wall), period=TICK, until=until)
    assert report.missed == 1  # 20 ms: the tick at 32 ms is skipped, that at 40 ms is not
    np.testing.assert_allclose(seen, [0, 0.008, 0.016, 0.024, 0.040, 0.048, 0.056, 0.064])
