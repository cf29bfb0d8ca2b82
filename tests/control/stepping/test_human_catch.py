"""A walk with ideal torques that the stepper takes over, with observations that a test makes up."""

from dataclasses import replace

import numpy as np
import pytest

from windup.control.stepping.supervisor import REST, Supervisor
from windup.hal.command import JointCommand
from windup.hal.observation import BaseState, JointState, Observation
from windup.robots import load_robot
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.stepping import find_stepping
from windup.tools.assembly.supervise import build_supervisor
from windup.tools.assembly.walk_options import WalkOptions

HUMAN = load_robot("human")
TICK = 0.001
WALK_TICK = 1.0 / HUMAN.rate_hz


def standing() -> Observation:
    zeros = np.zeros(len(HUMAN.joints))
    joints = JointState(HUMAN.poses["ready"].copy(), zeros, zeros, zeros, zeros, zeros)
    base = BaseState(np.array([0.0, 0.0, 0.9]), np.eye(4)[0], np.zeros(3), np.zeros(3))
    return Observation(0.0, joints, None, np.zeros(len(HUMAN.contacts.names)), base)


class Run:
    """A human that stands still and is told to walk, in the loop that its steps need."""

    def __init__(self) -> None:
        walker = build_walk(HUMAN, WalkOptions(open_loop=True), None)
        self.supervisor: Supervisor = build_supervisor(HUMAN, walker, "momentum")
        self.seen, self.ticks = standing(), 0
        self.supervisor.reset(self.seen)

    @property
    def holder(self) -> str:
        return self.supervisor.holder

    def go(self, ticks: int) -> list[JointCommand]:
        commands = []
        for _ in range(ticks):
            observation = replace(self.seen, time=self.ticks * TICK)
            commands.append(self.supervisor.step(observation, TICK))
            self.ticks += 1
        return commands


def test_the_walk_keeps_its_own_rate_in_a_faster_loop() -> None:
    run = Run()
    commands = run.go(2 * round(WALK_TICK / TICK))
    assert [command is commands[0] for command in commands] == [True] * 8 + [False] * 8
    moment = run.supervisor.walker.moment
    assert moment is not None
    assert moment.elapsed == pytest.approx(2 * WALK_TICK)


def test_torques_catch_a_push_and_the_walk_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    run, table = Run(), find_stepping(HUMAN).catch
    assert table is not None
    run.go(8)
    with monkeypatch.context() as pushed:
        pushed.setattr(run.supervisor, "_thrown", lambda *_: np.array([-2.0 * table.back, 0.0]))
        (command,) = run.go(1)
    assert run.holder == "step"
    assert not command.stiffness.any()
    assert np.abs(command.torque).max() > 1.0
    run.go(round(REST / TICK) + 1)
    assert run.holder == "return"
    run.go(round(table.resume / TICK) + 1)
    assert run.holder == "walk"
    assert len(run.supervisor.catches) == 1
