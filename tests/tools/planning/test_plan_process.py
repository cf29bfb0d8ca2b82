import pickle
import select
import signal
import socket
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest

from windup.control.limit_cycle.planner import StepPlanner, StepRequest
from windup.hal.controller import Stopwatch
from windup.hal.errors import PlannerError
from windup.hal.joints import Array
from windup.robots import load_robot
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.rollouts import RolloutPredictor
from windup.sim_twin.twin import Twin
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.planning.plan_process import ProcessPlanner, plan_aside
from windup.tools.planning.plan_worker import Question, Task, _newest

OP3 = load_robot("op3")
DT = 0.004
PREDICTOR = RolloutPredictor(OP3)
TASK = Task(OP3.folder, WalkOptions(), PREDICTOR.delay, OP3.model_latency, DT)


@dataclass
class Listener:
    """Takes requests down and never answers."""

    latency: float = OP3.model_latency
    requests: list[StepRequest] = field(default_factory=list)

    def reset(self) -> None:
        pass

    def ask(self, request: StepRequest) -> None:
        self.requests.append(request)

    def answer(self, time: float) -> Array | None:
        return None


@pytest.fixture(scope="module")
def request_() -> StepRequest:
    """The first step of a robot at rest."""
    walker = build_walk(OP3, WalkOptions(), PREDICTOR)
    walker.planner = listener = Listener()
    observation = TwinBackend(Twin(OP3)).read()
    walker.reset(observation)
    walker.step(observation, DT)
    return listener.requests[0]


@pytest.fixture(scope="module")
def planner() -> Iterator[ProcessPlanner]:
    with plan_aside(OP3, WalkOptions(), RolloutPredictor(OP3), DT) as planner:
        yield planner.wait_ready()


def wait(planner: ProcessPlanner) -> None:
    """Wait for a message from over there."""
    assert select.select([planner._link], [], [], 60.0)[0], "nothing came in a minute"


def test_another_process_plans_what_this_one_would(
    planner: ProcessPlanner, request_: StepRequest
) -> None:
    here = build_walk(OP3, WalkOptions(), PREDICTOR, latency=OP3.model_latency).planner
    assert isinstance(here, StepPlanner)
    planner.reset()
    planner.ask(request_)
    due = request_.start.observation.time + OP3.model_latency
    wait(planner)
    assert planner.answer(due - DT) is None
    answer = planner.answer(due)
    np.testing.assert_array_equal(answer, here.plan(request_))
    assert planner.answer(due + DT) is None
    assert planner.stopwatch.count == 5
    assert planner.stopwatch.seconds > 0.0


def test_the_answer_to_an_older_step_is_thrown_away(
    planner: ProcessPlanner, request_: StepRequest
) -> None:
    planner.reset()
    planner.ask(request_)
    wait(planner)
    before = planner.discarded
    other = replace(request_, target=request_.target + 0.01)
    planner.ask(other)
    while (answer := planner.answer(np.inf)) is None:
        wait(planner)
    assert planner.discarded == before + 1
    planner.reset()
    planner.ask(request_)
    wait(planner)
    again = planner.answer(np.inf)
    assert again is not None
    assert not np.array_equal(again, answer)


def test_asking_never_waits(request_: StepRequest) -> None:
    with ProcessPlanner(TASK) as planner:
        planner.wait_ready()
        planner._process.send_signal(signal.SIGSTOP)
        for _ in range(200):
            planner.ask(request_)
            assert planner.answer(np.inf) is None
        assert planner.discarded > 0
        planner._process.kill()


def test_a_process_that_dies_is_noticed(request_: StepRequest) -> None:
    with ProcessPlanner(TASK) as planner:
        planner.wait_ready()
        planner._process.kill()
        planner._process.wait()
        with pytest.raises(PlannerError, match=r"has died \(signal 9\).*run again"):
            planner.answer(0.0)
        with pytest.raises(PlannerError, match="has died"):
            planner.ask(request_)


def test_what_cannot_be_built_is_said_before_the_run(tmp_path: Path) -> None:
    task = replace(TASK, options=WalkOptions(gait="hop"))
    with ProcessPlanner(task) as planner, pytest.raises(PlannerError, match=r"unknown gait.*'hop'"):
        planner.wait_ready()


def test_a_request_that_fails_is_told(planner: ProcessPlanner, request_: StepRequest) -> None:
    with ProcessPlanner(TASK) as broken:
        broken.wait_ready()
        broken.ask(replace(request_, target=np.zeros(7)))
        wait(broken)
        with pytest.raises(PlannerError, match="failed: ValueError"):
            broken.answer(np.inf)


def test_a_busy_worker_takes_the_newest_question_and_forgets_as_it_was_told(
    request_: StepRequest,
) -> None:
    here, there = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with here, there:
        for number, fresh in ((1, False), (2, True), (3, False)):
            here.send(pickle.dumps(Question(number, request_, fresh)))
        newest = _newest(there)
        assert newest is not None
        assert (newest.number, newest.fresh) == (3, True)
        here.close()
        assert _newest(there) is None


def test_files_of_the_working_folder_are_not_imported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("queue", "socket"):
        (tmp_path / f"{name}.py").write_text(f"raise SystemExit('not the {name} of Python')")
    monkeypatch.chdir(tmp_path)
    with ProcessPlanner(TASK) as planner:
        planner.wait_ready()


def test_the_process_ends_with_its_planner() -> None:
    planner = ProcessPlanner(TASK, Stopwatch())
    planner.wait_ready()
    planner.close()
    assert planner._process.returncode == 0
