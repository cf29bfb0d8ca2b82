"""The fixed-rate loop: read, estimate, step, write; the same for a robot and for its twin."""

import time as wall
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from windup.control.returned import returned_command
from windup.hal.backend import Clock
from windup.hal.command import JointCommand
from windup.hal.controller import Controller, Stopwatch
from windup.hal.observation import Observation

# Called once a tick; a reason ends the run.
Until = Callable[[Observation], str | None]


class ReadsAndWrites(Protocol):
    """What the loop uses of a backend; a `GuardedBackend` has it."""

    @property
    def clock(self) -> Clock:
        """The clock that the schedule keeps."""
        ...

    def read(self) -> Observation:
        """Return the present state."""
        ...

    def write(self, command: JointCommand) -> JointCommand:
        """Send a command and return the command that was really applied."""
        ...


class Estimator(Protocol):
    """Fills in what the sensors do not measure."""

    def update(self, observation: Observation, dt: float) -> Observation:
        """Return `observation` with its base."""
        ...


class Recorder(Protocol):
    """Takes down every tick, in the tick's own time: it has to be quick, and never waits."""

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
        """Record one tick.

        Args:
            observation: What was observed.
            asked: Command of the controller.
            applied: Command that the joints really got.
            tick_time: Duration of read, estimate, step and write, s.
            lateness: Time from the scheduled start of the tick until it began, s.
            tick: Number of ticks of the run so far.
            missed: Number of ticks skipped so far.
        """
        ...


@dataclass
class LoopReport:
    """How a run went.

    Attributes:
        reason: Why it ended.
        ticks: Ticks run.
        missed: Ticks that came too late and were skipped.
        sim_time: Time on the backend's clock, s.
        first_motion: Part of it that the first motion after torque came on has taken, s.
        wall_time: Time on the wall, s.
        tick: Wall time of each tick (read, estimate, step, write; without rollouts), s.
    """

    reason: str = "done"
    ticks: int = 0
    missed: int = 0
    sim_time: float = 0.0
    first_motion: float = 0.0
    wall_time: float = 0.0
    tick: list[float] = field(default_factory=list, repr=False)

    def tick_ms(self) -> dict[str, float]:
        """Return the median and the 99th percentile of the tick, ms."""
        if not self.tick:
            return {"p50": 0.0, "p99": 0.0}
        p50, p99 = np.percentile(self.tick, [50, 99]) * 1e3
        return {"p50": float(p50), "p99": float(p99)}


class Schedule:
    """An absolute schedule of ticks, from now on; those that come too late are left out.

    Args:
        clock: The clock that it keeps.
        period: From one tick to the next, s.
    """

    def __init__(self, clock: Clock, period: float) -> None:
        self._clock, self._period = clock, period
        self._started, self._tick = clock.now(), 0

    @property
    def elapsed(self) -> float:
        """Time since it began, s."""
        return self._clock.now() - self._started

    @property
    def due(self) -> float:
        """Time from the beginning until the present tick is due, s."""
        return self._tick * self._period

    def advance(self) -> int:
        """Go on to the next tick that is still to come; return how many are left out."""
        self._tick += 1
        late = int(self.elapsed / self._period - self._tick + 1e-6)
        if late <= 0:
            return 0
        self._tick += late
        return late

    def wait(self) -> None:
        """Wait for that tick."""
        self._clock.wait_until(self._started + self._tick * self._period)


class TickLoop:
    """The fixed-rate loop, one phase after the other: `observe`, `command`, `finish`, and again.

    The schedule is absolute; ticks that come too late are skipped and counted.

    Args:
        backend: The guarded backend, connected and configured.
        controller: The controller.
        period: Period of the loop, s.
        until: Called with each observation; a reason ends the run.
        estimator: Fills in the base state.
        rollouts: Time to leave out of the ticks.
        report: Filled in as the run goes, so that an interrupted run has measured something.
        recorder: Takes down every tick.

    Attributes:
        observation: Observation of the present tick; None before the first.
        applied: Command of the present tick that the joints really got; None until `command`.
        recorder: Takes down every tick.
    """

    def __init__(
        self,
        backend: ReadsAndWrites,
        controller: Controller,
        *,
        period: float,
        until: Until,
        estimator: Estimator | None = None,
        rollouts: Stopwatch | None = None,
        report: LoopReport | None = None,
        recorder: Recorder | None = None,
    ) -> None:
        self.report = report or LoopReport()
        self.observation: Observation | None = None
        self.applied: JointCommand | None = None
        # Bound methods, looked up once: they are called on every tick.
        self._read, self._write, self._step = backend.read, backend.write, controller.step
        self._controller = controller
        self._reset: Callable[[Observation], None] | None = controller.reset
        self._period, self._until, self._estimator = period, until, estimator
        self._rollouts, self.recorder = rollouts or Stopwatch(), recorder
        self._schedule, self._late = Schedule(backend.clock, period), 0.0
        self._wall_started = wall.perf_counter()

    def observe(self) -> Observation | None:
        """Begin a tick: return its observation, or None if there is a reason to end the run.

        Raises:
            WindupError: Whatever the backend, the estimator or the controller raise.
        """
        self._began, self._played = wall.perf_counter(), self._rollouts.seconds
        observation = self._read()
        if self._estimator is not None:
            observation = self._estimator.update(observation, self._period)
        self.observation, self.applied = observation, None
        if (reason := self._until(observation)) is not None:
            self.report.reason = reason
            return None
        if self._reset is not None:
            self._reset(observation)
            self._reset = None
        return observation

    def command(self) -> JointCommand:
        """Ask the controller for the command of this tick, send it, and return what was applied.

        Raises:
            ControllerError: The controller returned no command.
            WindupError: Whatever the controller, the guard or the backend raise.
        """
        assert self.observation is not None, "a tick begins with an observation"
        asked = self._step(self.observation, self._period)
        self._asked = returned_command(asked, self._controller)
        self.applied = self._write(self._asked)
        return self.applied

    def finish(self) -> None:
        """End a tick, with its command if there was none, and wait for the next one.

        Raises:
            WindupError: As of `command`.
        """
        applied = self.command() if self.applied is None else self.applied
        report, schedule = self.report, self._schedule
        spent = wall.perf_counter() - self._began - (self._rollouts.seconds - self._played)
        report.tick.append(spent)
        report.ticks += 1
        if self.recorder is not None:
            assert self.observation is not None, "a tick begins with an observation"
            self.recorder.record(
                self.observation, self._asked, applied, spent, self._late, report.ticks,
                report.missed,
            )  # fmt: skip
        report.missed += schedule.advance()
        schedule.wait()
        report.sim_time = schedule.elapsed
        self._late = report.sim_time - schedule.due
        report.wall_time = wall.perf_counter() - self._wall_started


def run_loop(
    backend: ReadsAndWrites,
    controller: Controller,
    *,
    period: float,
    until: Until,
    estimator: Estimator | None = None,
    rollouts: Stopwatch | None = None,
    report: LoopReport | None = None,
    recorder: Recorder | None = None,
) -> LoopReport:
    """Run `controller` on `backend` every `period` s until there is a reason to stop.

    Args:
        backend: The guarded backend, connected and configured.
        controller: The controller.
        period: Period of the loop, s.
        until: Called with each observation; a reason ends the run.
        estimator: Fills in the base state.
        rollouts: Time to leave out of the ticks.
        report: Filled in as the run goes, so that an interrupted run has measured something.
        recorder: Takes down every tick.

    Raises:
        WindupError: Whatever the backend, the guard or the controller raise.
    """
    loop = TickLoop(
        backend,
        controller,
        period=period,
        until=until,
        estimator=estimator,
        rollouts=rollouts,
        report=report,
        recorder=recorder,
    )
    while loop.observe() is not None:
        loop.finish()
    return loop.report
