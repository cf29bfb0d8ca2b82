from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from tests.small_world import JOINTS, FakeBackend, FakeClock, N
from windup.control.loop import LoopReport, run_loop
from windup.hal.command import JointCommand
from windup.hal.controller import Stopwatch
from windup.hal.errors import UnsafeCommandError
from windup.hal.guard import GuardedBackend, SafetyLimits
from windup.hal.observation import BaseState, Observation

PERIOD = 0.25  # binary, so that times add up exactly


@dataclass
class Counter:
    """Asks every joint for 0.01 rad more each tick, and remembers what it saw."""

    resets: list[float] = field(default_factory=list)
    seen: list[Observation] = field(default_factory=list)
    dts: set[float] = field(default_factory=set)

    def reset(self, observation: Observation) -> None:
        self.resets.append(observation.time)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        self.seen.append(observation)
        self.dts.add(dt)
        return JointCommand.hold(JOINTS, np.full(N, 0.01 * len(self.seen)))


def guard(late: dict[int, float] | None = None, start: float = 0.0) -> GuardedBackend:
    clock = FakeClock(start, late or {})
    return GuardedBackend(FakeBackend(clock=clock), SafetyLimits.of(JOINTS))


def clock(backend: GuardedBackend) -> FakeClock:
    assert isinstance(backend.clock, FakeClock)
    return backend.clock


def run(backend: GuardedBackend, controller: Counter, until: float = 2.0) -> LoopReport:
    return run_loop(
        backend,
        controller,
        period=PERIOD,
        until=lambda observation: "far enough" if observation.time >= until else None,
    )


def test_every_tick_reads_steps_and_writes_once() -> None:
    backend, controller = guard(), Counter()
    report = run(backend, controller)
    assert [seen.time for seen in controller.seen] == [PERIOD * i for i in range(8)]
    assert isinstance(backend.backend, FakeBackend)
    asked = [command.position[0] for command in backend.backend.written]
    np.testing.assert_allclose(asked, 0.01 * np.arange(1, 9))
    assert controller.dts == {PERIOD}
    assert (report.reason, report.ticks, report.missed) == ("far enough", 8, 0)
    assert report.sim_time == 2.0


def test_the_controller_is_reset_once_with_the_first_observation() -> None:
    controller = Counter()
    run(guard(start=1.0), controller)
    assert controller.resets == [1.0]


def test_a_reason_at_the_first_observation_means_that_nothing_is_written() -> None:
    backend, controller = guard(), Counter()
    report = run(backend, controller, until=0.0)
    assert isinstance(backend.backend, FakeBackend)
    assert (backend.backend.written, controller.resets, report.ticks) == ([], [], 0)


def test_the_schedule_is_absolute_so_that_lateness_does_not_add_up() -> None:
    backend = guard(late={1: 0.1, 2: 0.1, 5: 0.2})
    report = run(backend, Counter())
    assert clock(backend).asked == [PERIOD * i for i in range(1, 9)]
    assert report.missed == 0


def test_ticks_that_come_too_late_are_skipped_and_counted() -> None:
    backend, controller = guard(late={2: 2.5 * PERIOD}), Counter()
    report = run(backend, controller, until=4.0)
    # The third tick begins 2.5 periods late: one has passed whole, the next is late by half.
    assert [seen.time / PERIOD for seen in controller.seen][:5] == [0.0, 1.0, 4.5, 4.5, 5.0]
    assert report.missed == 1
    assert report.ticks + report.missed == 16


@pytest.mark.parametrize("late", [0.25, 1.0, 3.75, 7.25])
def test_after_any_lateness_the_schedule_is_kept_again(late: float) -> None:
    backend, controller = guard(late={3: late * PERIOD}), Counter()
    report = run(backend, controller, until=5.0)
    assert (np.diff(clock(backend).asked) > 0.0).all()
    assert report.missed == max(int(late) - 1, 0)
    assert report.ticks + report.missed == 20
    assert [seen.time for seen in controller.seen][-6:] == [
        5.0 - PERIOD * i for i in range(6, 0, -1)
    ]


def test_an_estimator_fills_in_what_the_controller_sees() -> None:
    truth = BaseState(np.ones(3), np.ones(4), np.ones(3), np.ones(3))

    class Estimator:
        def update(self, observation: Observation, dt: float) -> Observation:
            return replace(observation, base=truth)

    controller = Counter()
    run_loop(
        guard(),
        controller,
        period=PERIOD,
        until=lambda observation: "done" if observation.time >= 1.0 else None,
        estimator=Estimator(),
    )
    assert all(seen.base is truth for seen in controller.seen)


@dataclass
class Notes:
    """Records the ticks of a run."""

    applied: list[float] = field(default_factory=list)
    asked: list[float] = field(default_factory=list)
    late: list[float] = field(default_factory=list)
    counts: list[tuple[int, int]] = field(default_factory=list)

    def record(
        self,
        observation: Observation,
        asked: JointCommand,
        applied: JointCommand,
        tick_time: float,
        lateness: float,
        tick: int,
        missed: int,
    ) -> None:
        self.asked.append(float(asked.position[0]))
        self.applied.append(float(applied.position[0]))
        self.late.append(lateness)
        self.counts.append((tick, missed))


def test_a_recorder_gets_what_was_asked_what_was_applied_and_how_late_a_tick_began() -> None:
    class Reaching(Counter):
        def step(self, observation: Observation, dt: float) -> JointCommand:
            return JointCommand.hold(JOINTS, np.full(N, 9.0))

    notes = Notes()
    run_loop(
        guard(late={2: 0.1, 4: 2.5 * PERIOD}),
        Reaching(),
        period=PERIOD,
        until=lambda observation: "done" if observation.time >= 2.0 else None,
        recorder=notes,
    )
    assert set(notes.asked) == {9.0}
    assert set(notes.applied) == {1.0}, "the guard's limit"
    assert notes.late == pytest.approx([0.0, 0.0, 0.1, 0.0, 2.5 * PERIOD, 0.5 * PERIOD, 0.0])
    assert notes.counts[-1] == (7, 1)


def test_an_interrupted_run_has_measured_something() -> None:
    report = LoopReport()

    class Impatient(Counter):
        def step(self, observation: Observation, dt: float) -> JointCommand:
            if observation.time >= 1.0:
                raise KeyboardInterrupt
            return super().step(observation, dt)

    with pytest.raises(KeyboardInterrupt):
        run_loop(guard(), Impatient(), period=PERIOD, until=lambda _: None, report=report)
    assert (report.ticks, report.sim_time) == (4, 1.0)
    assert len(report.tick) == 4


def test_what_the_guard_refuses_ends_the_run() -> None:
    class Broken(Counter):
        def step(self, observation: Observation, dt: float) -> JointCommand:
            block = super().step(observation, dt).block.copy()
            block[0, 3] = np.nan
            return JointCommand(block)

    with pytest.raises(UnsafeCommandError, match="position nan for joint 'r_hip'"):
        run(guard(), Broken())


def test_rollouts_do_not_count_as_time_of_a_tick() -> None:
    watch = Stopwatch()

    class Planner(Counter):
        def step(self, observation: Observation, dt: float) -> JointCommand:
            watch.add(5, 1000.0)  # far longer than any tick of this test
            return super().step(observation, dt)

    report = run_loop(
        guard(),
        Planner(),
        period=PERIOD,
        until=lambda observation: "done" if observation.time >= 1.0 else None,
        rollouts=watch,
    )
    assert max(report.tick) < 0.0


def test_percentiles_are_in_milliseconds() -> None:
    report = LoopReport(tick=[0.001] * 99 + [0.1])
    assert report.tick_ms()["p50"] == pytest.approx(1.0)
    assert 1.0 < report.tick_ms()["p99"] < 100.0
    assert LoopReport().tick_ms() == {"p50": 0.0, "p99": 0.0}
