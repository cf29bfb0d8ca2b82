from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
import pytest

from windup.control.limit_cycle.balancer import Balancer
from windup.control.limit_cycle.planner import StepPlanner, StepRequest
from windup.control.regulation.disturbance_detector import DisturbanceDetector
from windup.hal.controller import RolloutStart
from windup.hal.joints import Array
from windup.robots import load_robot
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.twin import Twin
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.robot.robot import Robot

LATENCY = 0.06


def request(dt: float, time: float = 1.0) -> StepRequest:
    twin = TwinBackend(Twin(load_robot("op3")))
    twin.twin.data.time = time
    start = RolloutStart(twin.read(), np.zeros((0, 20)), dt)
    return StepRequest(start, None, 0, 0, *(np.zeros(1),) * 3)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("latency", "dt", "ticks"), [(0.0, 0.004, 0), (0.06, 0.004, 15), (0.06, 0.008, 8)]
)
def test_an_answer_acts_at_a_whole_tick(latency: float, dt: float, ticks: int) -> None:
    asked = request(dt)
    assert asked.ticks(latency) == ticks
    assert asked.due(latency) == pytest.approx(1.0 + (ticks - 0.5) * dt)


@dataclass
class Late:
    """Answers ever higher stride, at `latency` s into the first steps and then never."""

    latency: float = LATENCY
    behind: float = 0.0
    silent_from: int = 99
    requests: list[StepRequest] = field(default_factory=list)
    answered: int = 0

    def reset(self) -> None:
        self.requests.clear()
        self.answered = 0

    def ask(self, request: StepRequest) -> None:
        self.requests.append(request)

    def answer(self, time: float) -> Array | None:
        number = len(self.requests)
        if number >= self.silent_from or self.answered == number:
            return None
        if time < self.requests[-1].due(self.latency) + self.behind:
            return None
        self.answered = number
        return 0.1 * number * np.ones(4)


def walk(planner: Late, steps: int, shaken: DisturbanceDetector | None = None) -> Balancer:
    with Robot.open("op3") as robot:
        walker = build_walk(robot.description, WalkOptions(), robot.predictor)
        walker.planner, walker.shaken = planner, shaken
        robot.start_at(walker.gait.file.start)
        robot.run(walker, until=lambda _: "done" if walker.steps >= steps else None)
    return walker


def test_until_the_answer_the_last_k_of_the_same_side_acts() -> None:
    planner = Late()
    walker = walk(planner, 4)
    columns = [walker.gait.index(name) for name in walker.perturbations]
    kept = [(ask.before - ask.scale)[columns] for ask in planner.requests[:4]]
    np.testing.assert_allclose(kept[0], 0.0)
    np.testing.assert_allclose(kept[1], 0.0)
    np.testing.assert_allclose(kept[2], 0.1)
    np.testing.assert_allclose(kept[3], 0.2)
    for k, record in enumerate(walker.records):
        found = (record.scale - planner.requests[k].scale)[columns]
        np.testing.assert_allclose(found, 0.1 * (k + 1))
    assert walker.late == 0


def test_answers_that_are_late_or_never_come_are_counted() -> None:
    assert walk(Late(behind=0.02), 4).late == 4
    silent = Late(silent_from=3)
    walker = walk(silent, 4)
    assert walker.late == 2  # the third and the fourth
    np.testing.assert_allclose(walker.records[3].scale, silent.requests[3].before)


def test_a_step_planned_again_keeps_its_scalings_and_its_beginning_until_the_answer() -> None:
    planner = Late()
    walker = walk(
        planner, 4, DisturbanceDetector(threshold=0.0)
    )  # every state but those never seen
    assert walker.replans > 0
    assert len(planner.requests) == 5 + walker.replans
    pairs = list(pairwise(planner.requests))
    again = [(one, two) for one, two in pairs if one.origin is two.origin]
    assert len(again) == walker.replans
    for number, (one, two) in enumerate(pairs, 1):
        if one.origin is two.origin:
            assert two.start.observation.time > one.start.observation.time
            columns = [walker.gait.index(name) for name in walker.perturbations]
            answered = one.due(LATENCY) <= two.start.observation.time
            if answered:
                np.testing.assert_allclose((two.before - two.scale)[columns], 0.1 * number)


def test_a_planner_with_a_latency_walks_in_simulated_time() -> None:
    with Robot.open("op3", noise=0.2) as robot:
        walker = build_walk(robot.description, WalkOptions(), robot.predictor, latency=LATENCY)
        assert isinstance(walker.planner, StepPlanner)
        assert walker.planner.latency == LATENCY
        robot.start_at(walker.gait.file.start)
        robot.run(walker, until=lambda _: "done" if walker.steps >= 12 else None)
        assert not robot.fallen
    assert walker.late == 0
