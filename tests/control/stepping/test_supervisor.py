"""Who has the robot, with observations that somebody makes up; `windup push` shows it on one."""

from dataclasses import replace

import pytest

from tests.control.execution.test_footing import OP3, STANCE, seen
from windup.control.stepping.supervisor import REST, Supervisor
from windup.hal.observation import Observation
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.supervise import build_supervisor
from windup.tools.assembly.walk_options import WalkOptions

TICK = 0.004
LEARNT = 2.5
"""Time for the steps that make a walk usual, s."""


class Run:
    """A supervised walk, nobody's balance, of a robot whose base drifts as it is told."""

    def __init__(self) -> None:
        walker = build_walk(OP3, WalkOptions(open_loop=True), None)
        self.supervisor: Supervisor = build_supervisor(OP3, walker, "predictive")
        self.time = 0.0
        self.supervisor.reset(self.seen(0.0))

    @property
    def holder(self) -> str:
        return self.supervisor.holder

    def seen(self, drift: float) -> Observation:
        return replace(seen(drift=drift), time=self.time)

    def go(self, seconds: float, drift: float = 0.0) -> None:
        observation = self.seen(drift)
        for _ in range(round(seconds / TICK)):
            self.supervisor.step(replace(observation, time=self.time), TICK)
            self.time += TICK


@pytest.fixture(scope="module")
def walking() -> Run:
    run = Run()
    run.go(LEARNT)
    return run


def test_a_walk_is_learnt_before_it_is_judged() -> None:
    run = Run()
    run.go(0.3)
    run.go(0.1, drift=-0.5)
    assert run.holder == "walk"


def test_what_throws_it_forward_or_hardly_at_all_is_the_walks(walking: Run) -> None:
    for drift in (0.5, -0.1):
        walking.go(0.1, drift)
        assert walking.holder == "walk"
        walking.go(1.0)
    assert not walking.supervisor.catches


def test_what_comes_back_late_from_another_push_is_the_walks(walking: Run) -> None:
    walking.go(0.16, drift=0.5)
    walking.go(0.04, drift=-0.5)
    assert walking.holder == "walk"
    walking.go(1.0)


def test_what_throws_it_back_goes_to_the_stepper_which_halts_and_hands_back(walking: Run) -> None:
    supervisor = walking.supervisor
    began = walking.time
    walking.go(0.1, drift=-0.5)
    assert walking.holder == "step"
    catch = supervisor.catches[-1]
    assert catch.time == pytest.approx(began, abs=2 * TICK)
    assert catch.thrown[0] < -supervisor.table.back
    assert supervisor.stepper.steps > 0
    walking.go(1.5)
    assert catch.stood is not None
    assert catch.stood > catch.time + REST
    walked = supervisor.walker.steps
    assert walked == catch.after
    walking.go(2.0)
    assert walking.holder == "walk"
    assert catch.back == pytest.approx(catch.stood + supervisor.table.resume, abs=2 * TICK)
    assert supervisor.walker.steps > walked
    assert catch.record(supervisor.walker.steps)["walked_after"] == (
        supervisor.walker.steps - walked
    )


def test_the_stepper_begins_where_the_robot_is_and_takes_time_for_its_stance() -> None:
    run = Run()
    run.go(LEARNT)
    observation = run.seen(-0.5)
    arm = OP3.joints.names.index("l_el")
    observation.joints.position[arm] += 0.5
    command = run.supervisor.step(observation, TICK)
    assert run.holder == "step"
    assert command.position[arm] == pytest.approx(observation.joints.position[arm])
    run.go(0.6)
    command = run.supervisor.step(run.seen(0.0), TICK)
    assert command.position[arm] == pytest.approx(STANCE[arm])
