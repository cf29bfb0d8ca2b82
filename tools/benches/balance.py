"""Measures the cost of a step's rollouts relative to the step's duration."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from statistics import median
from typing import Any, NamedTuple

import numpy as np

from windup.control.limit_cycle.planner import StepPlanner, StepRequest
from windup.hal.errors import WindupError
from windup.hal.joints import Array
from windup.sim_twin.rollouts import RolloutPredictor
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.robot.robot import Robot

ROUNDS = 20
WARM_UP = 5


class StepTimes(NamedTuple):
    """One step: its duration, and the time of all rollouts on one and two threads and of one, s."""

    duration: float
    one: float
    two: float
    single: float


@dataclass
class Recorder:
    """A planner that records the requests which it passes on.

    Attributes:
        planner: The planner that answers.
        requests: The requests so far.
    """

    planner: StepPlanner
    requests: list[StepRequest] = field(default_factory=list)

    @property
    def latency(self) -> float:
        """The planner's latency, s."""
        return self.planner.latency

    def reset(self) -> None:
        """Forget all steps."""
        self.planner.reset()

    def ask(self, request: StepRequest) -> None:
        """Record the request and pass it on."""
        self.requests.append(request)
        self.planner.ask(request)

    def answer(self, time: float) -> Array | None:
        """Return the planner's answer."""
        return self.planner.answer(time)


def measure_balance(name: str) -> dict[str, Any]:
    """Return the times of a step's rollouts: all on one and on two threads, and a single one.

    The steps are those of a real walk; the two predictors take turns on each.

    Raises:
        WindupError: The robot fell before there were enough steps to measure.
    """
    with Robot.open(name) as robot:
        walker = build_walk(robot.description, WalkOptions(), robot.predictor)
        assert isinstance(walker.planner, StepPlanner)
        recorder = Recorder(walker.planner)
        walker.planner = recorder
        robot.start_at(walker.gait.file.start)
        steps = WARM_UP + ROUNDS
        robot.run(walker, until=lambda _: "done" if walker.steps >= steps else None)
        if walker.steps < steps:
            raise WindupError(f"{name} fell in step {walker.steps + 1} and cannot be measured")
        one = RolloutPredictor(robot.description, threads=1)
        two = RolloutPredictor(robot.description, threads=2)
        durations = [record.duration for record in walker.records]
        rounds = zip(recorder.requests[:steps], durations, strict=True)
        every = 1 + len(walker.perturbations) * (1 + recorder.planner.model.centred)
        laps = [
            StepTimes(
                duration,
                _time(recorder.planner, one, request, every),
                _time(recorder.planner, two, request, every),
                _time(recorder.planner, one, request, 1),
            )
            for request, duration in rounds
        ][WARM_UP:]
    return {
        "rounds": len(laps),
        "step_s": round(median(lap.duration for lap in laps), 4),
        "rollouts": every,
        "one_thread_share_of_step": _share(lap.one / lap.duration for lap in laps),
        "two_threads_share_of_step": _share(lap.two / lap.duration for lap in laps),
        "two_threads_over_one": _share(lap.two / lap.one for lap in laps),
        "one_rollout_share_of_step": _share(lap.single / lap.duration for lap in laps),
    }


def _share(ratios: Iterable[float]) -> float:
    return round(median(ratios), 4)


def _time(
    planner: StepPlanner, predictor: RolloutPredictor, request: StepRequest, rollouts: int
) -> float:
    """Return the wall-clock time of `rollouts` rollouts of one step, s."""
    scale = np.repeat(request.scale[None], rollouts, axis=0)
    predictor.predict(request.start, planner.policy(request, scale), planner.horizon)
    return predictor.stopwatch.laps[-1]
