"""When the walker shifts and steps, with an executor that does at once what it is told."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import pytest

from tests.control.biped import robot_state
from windup.control.execution.motion import Planted, WalkMotion
from windup.control.footprints.directed_file import Directed
from windup.control.footprints.footprint_walker import FootprintWalker
from windup.control.footprints.footprints import Footprint
from windup.control.kinematics.robot_state import RobotState
from windup.hal.command import JointCommand
from windup.hal.joints import Array, Joint, Joints
from windup.hal.observation import JointState, Observation
from windup.hal.publishing.controller_block import ControllerBlock

TICK = 0.01
JOINTS = Joints((Joint("leg", lower=-1.0, upper=1.0, stiffness=1.0, damping=0.1, torque=1.0),))
ZERO = np.zeros(1)
HOW = Directed(
    stance="stand", shift=0.5, swing=0.4, land=0.1, lift=0.05, height=0.2, near=0.01, quiet=0.1
)
STEPS = (Footprint(0, np.array([0.1, 0.2, 0.0])), Footprint(1, np.array([0.0, -0.2, 0.0])))


@dataclass
class Ideal:
    """A body whose weight and feet are where the motion has them."""

    state: RobotState = field(default_factory=robot_state)
    contact: bool = True
    places: Array = field(default_factory=lambda: np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]))
    com: Array = field(default_factory=lambda: np.zeros(2))
    com_velocity: Array = field(default_factory=lambda: np.zeros(2))
    yaw: float = 0.0
    height: float = 0.25
    follows_feet: bool = False

    def reset(self, observation: Observation) -> None: ...

    def observe(self, observation: Observation) -> None: ...

    def due(self, now: float, dt: float) -> bool:
        return True

    def touches(self, foot: int) -> bool:
        return self.contact

    def middle(self, foot: int) -> Array:
        return np.asarray(self.places[foot, :2])

    def lift_off(self, foot: int, planted: Planted) -> Array:
        return np.append(self.places[foot, :2], 0.0)

    def realise(self, motion: WalkMotion, now: float, dt: float) -> JointCommand:
        self.com = motion.shift.at(now)
        if (swing := motion.swing) is not None:
            at, yaw = swing.at(now)
            self.places[swing.foot] = [*at[:2], yaw]
        return JointCommand.hold(JOINTS, ZERO)


class Walk:
    """A walk, and the phases that it went through with their times."""

    def __init__(self, body: Ideal, prints: Sequence[Footprint], how: Directed = HOW) -> None:
        self.walker, self.time = FootprintWalker(body, prints, how), 0.0
        self.walker.reset(self.seen())
        self.phases = [("rest", 0.0)]

    def seen(self) -> Observation:
        joints = JointState(ZERO, ZERO, ZERO, ZERO, ZERO, ZERO)
        return Observation(self.time, joints, None, np.zeros(0), None)

    def go(self, seconds: float) -> None:
        for _ in range(round(seconds / TICK)):
            self.time += TICK
            self.walker.step(self.seen(), TICK)
            if self.walker.motion.phase != self.phases[-1][0]:
                self.phases.append((self.walker.motion.phase, round(self.time, 6)))


def test_the_weight_shifts_before_each_step_and_comes_to_the_middle_at_the_end() -> None:
    body = Ideal()
    walk = Walk(body, STEPS)
    walk.go(4.0)
    names = [name for name, _ in walk.phases]
    assert names == ["rest", *("shift", "swing", "land") * 2, "rest"]
    assert np.diff([time for _, time in walk.phases]) == pytest.approx(
        [0.5, 0.5, 0.4, 0.1, 0.5, 0.4, 0.1], abs=1.5 * TICK
    )
    assert walk.walker.finished
    assert (walk.walker.landed, walk.walker.stood) == (2, 2)
    assert body.places == pytest.approx(np.array([[0.1, 0.1, 0], [0.1, -0.1, 0]]), abs=2e-3)
    assert body.com == pytest.approx([0.1, 0.0], abs=2e-3)


def test_the_phase_is_published() -> None:
    walk = Walk(Ideal(), STEPS)
    block = ControllerBlock.of(walk.walker.published)
    seen = []
    for _ in range(40):
        walk.go(0.1)
        walk.walker.publish(block)
        seen.append((walk.walker.published.phases[block.phase], block.run_state.words))
    assert {phase for phase, _ in seen} == {"rest", "shift", "swing", "land"}
    assert ("swing", "stepping") in seen and ("shift", "stepping") in seen
    assert seen[-1] == ("rest", "standing")


def test_a_foot_that_does_not_touch_is_waited_for_but_not_for_ever() -> None:
    walk = Walk(Ideal(contact=False), STEPS[:1])
    walk.go(2.5)
    times = dict(walk.phases)
    assert times["land"] - times["swing"] == pytest.approx(2 * HOW.swing, abs=1.5 * TICK)


def test_a_weight_that_does_not_come_to_rest_is_waited_for_but_not_for_ever() -> None:
    walk = Walk(Ideal(com_velocity=np.array([0.2, 0.0])), STEPS[:1])
    walk.go(3.5)
    times = dict(walk.phases)
    waited = HOW.patience * HOW.shift
    assert times["shift"] == pytest.approx(waited, abs=2.5 * TICK)
    assert times["swing"] - times["shift"] == pytest.approx(waited, abs=2.5 * TICK)


def test_footprints_in_the_frame_of_the_start_are_seen_from_the_stance_foot() -> None:
    body = Ideal()
    walk = Walk(body, [Footprint(0, np.array([0.05, 0.12, 0.3]), "start", duration=0.6)])
    walk.go(3.0)
    assert body.places[0] == pytest.approx([0.05, 0.12, 0.3], abs=2e-3)
    times = dict(walk.phases)
    assert times["land"] - times["swing"] == pytest.approx(0.6, abs=1.5 * TICK)
