from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pytest

from windup.hal.command import JointCommand
from windup.hal.controller import Outcomes, PolicyInput, RolloutStart
from windup.hal.joints import Array, Mask
from windup.hal.observation import Observation
from windup.robots import RobotDescription
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.ground.terrain import Ground
from windup.sim_twin.rollouts import RolloutPredictor
from windup.sim_twin.twin import Twin

BEFORE = 20  # ticks that the twin has moved when the prediction begins
AHEAD = 25  # ticks predicted


class Script:
    """A batch policy that plays rows of goals (m, ticks, n) and is done after the last."""

    def __init__(self, goals: Array) -> None:
        self.goals, self.size = goals, len(goals)
        self.done: Mask = np.zeros(self.size, dtype=bool)
        self.seen: list[PolicyInput] = []
        self._tick = 0

    def step(self, state: PolicyInput, dt: float) -> Array:
        ticks = self.goals.shape[1]
        self.seen.append(replace(state, joint_position=state.joint_position.copy()))
        self.done = np.full(self.size, self._tick >= ticks)
        goals: Array = self.goals[:, min(self._tick, ticks - 1)]
        self._tick += 1
        return goals


def wave(robot: RobotDescription, ticks: Sequence[int], size: float = 0.15) -> Array:
    """Return goals (ticks, n) that swing about the stance."""
    phase = 0.25 * np.array(ticks)[:, None] + np.arange(len(robot.joints))
    swing: Array = robot.stance + size * np.sin(phase)
    return np.clip(swing, robot.joints.lower, robot.joints.upper)


@dataclass
class Scene:
    """A moving twin, what was observed of it, and what it then did."""

    robot: RobotDescription
    start: RolloutStart
    end: Observation
    twin: Twin

    @property
    def script(self) -> Script:
        return Script(wave(self.robot, range(BEFORE, BEFORE + AHEAD))[None])


def scene(robot: RobotDescription, delay: float | None = None) -> Scene:
    twin = Twin(robot, delay=delay)
    backend = TwinBackend(twin)
    dt = 1.0 / robot.rate_hz
    sent: list[Array] = []

    def play(first: int, ticks: int) -> None:
        for goal in wave(robot, range(first, first + ticks)):
            real = backend.write(JointCommand.hold(robot.joints, goal))
            sent.append(real.position)
            backend.clock.wait_until((len(sent)) * dt)

    play(0, BEFORE)
    start = RolloutStart(backend.read(), np.array(sent), dt)
    play(BEFORE, AHEAD)
    return Scene(robot, start, backend.read(), twin)


def misses(outcome: Outcomes, end: Observation) -> dict[str, float]:
    """Return how far a prediction is from what happened."""
    assert end.base is not None
    return {
        "base": float(np.abs(outcome.base_position[0] - end.base.position).max()),
        "orientation": float(np.abs(outcome.base_orientation[0] - end.base.orientation).max()),
        "velocity": float(np.abs(outcome.base_velocity[0, :3] - end.base.linear_velocity).max()),
        "joints": float(np.abs(outcome.joint_position[0] - end.joints.position).max()),
    }


def test_a_rollout_of_the_human_is_what_the_twin_then_does(human: RobotDescription) -> None:
    world = scene(human)
    outcome = RolloutPredictor(human).predict(world.start, world.script, 1.0)
    assert max(misses(outcome, world.end).values()) < 1e-6
    assert outcome.duration[0] == pytest.approx(AHEAD / human.rate_hz)
    assert not outcome.fell[0]
    twin = world.twin
    twin.restore(twin.save())  # MuJoCo leaves derived quantities at the step's beginning
    data, base = twin.data, twin.model.body(human.base).id
    np.testing.assert_allclose(outcome.torso[0], twin.up, atol=1e-6)
    np.testing.assert_allclose(outcome.com[0], data.subtree_com[base], atol=1e-6)
    velocity = data.sensor("com_velocity").data
    np.testing.assert_allclose(outcome.com_velocity[0], velocity, atol=1e-6)
    feet = [data.site(foot.site).xpos for foot in human.feet]
    np.testing.assert_allclose(outcome.feet[0], feet, atol=1e-6)


@pytest.mark.parametrize("delay", [0.008, 0.024])
def test_a_rollout_of_op3_is_close_to_what_the_twin_then_does(
    op3: RobotDescription, delay: float
) -> None:
    world = scene(op3, delay)
    predictor = RolloutPredictor(op3, delay=delay)
    # Encoders count in 1.5 mrad, and the goals of the rollout are not rounded.
    missed = misses(predictor.predict(world.start, world.script, 1.0), world.end)
    assert missed["joints"] < 0.006
    assert missed["base"] < 0.001
    assert missed["orientation"] < 0.004
    # The control: who forgets what is in flight is far off.
    forgetful = replace(world.start, in_flight=world.start.in_flight[:0])
    forgot = misses(predictor.predict(forgetful, world.script, 1.0), world.end)
    assert forgot["joints"] > 0.012
    assert forgot["joints"] > 4.0 * missed["joints"]
    assert forgot["base"] > 4.0 * missed["base"]


def test_the_human_with_a_delay_is_predicted_exactly_only_with_what_is_in_flight(
    human: RobotDescription,
) -> None:
    world = scene(human, delay=0.016)
    predictor = RolloutPredictor(human, delay=0.016)
    known = misses(predictor.predict(world.start, world.script, 1.0), world.end)
    assert max(known.values()) < 1e-6
    forgetful = replace(world.start, in_flight=world.start.in_flight[:0])
    forgot = misses(predictor.predict(forgetful, world.script, 1.0), world.end)
    assert forgot["joints"] > 1e-4
    assert forgot["velocity"] > 1e-3


def test_the_policy_first_sees_the_observation_itself(op3: RobotDescription) -> None:
    world = scene(op3)
    script = world.script
    RolloutPredictor(op3).predict(world.start, script, 1.0)
    seen, base = world.start.observation, world.start.observation.base
    assert base is not None
    np.testing.assert_array_equal(script.seen[0].joint_position[0], seen.joints.position)
    np.testing.assert_array_equal(script.seen[0].contacts[0], seen.contacts)
    assert len(script.seen) == AHEAD + 1


def three(robot: RobotDescription) -> Array:
    """Return three different scripts (3, ticks, n)."""
    ticks = range(BEFORE, BEFORE + AHEAD)
    return np.stack([wave(robot, ticks, size) for size in (0.05, 0.1, 0.15)])


def fields(outcomes: Outcomes) -> dict[str, Array]:
    return {name: getattr(outcomes, name) for name in Outcomes.__dataclass_fields__}


@pytest.mark.parametrize("name", ["op3", "human"])
def test_one_and_two_threads_give_the_same_bytes(name: str, request: pytest.FixtureRequest) -> None:
    robot: RobotDescription = request.getfixturevalue(name)
    start = scene(robot).start
    one, two = (
        fields(RolloutPredictor(robot, threads=n).predict(start, Script(three(robot)), 1.0))
        for n in (1, 2)
    )
    assert {key: value.tobytes() for key, value in one.items()} == {
        key: value.tobytes() for key, value in two.items()
    }


@pytest.mark.parametrize("name", ["op3", "human"])
def test_a_batch_is_as_many_single_rollouts(name: str, request: pytest.FixtureRequest) -> None:
    robot: RobotDescription = request.getfixturevalue(name)
    start, predictor = scene(robot).start, RolloutPredictor(robot)
    scripts = three(robot)
    whole = fields(predictor.predict(start, Script(scripts), 1.0))
    for row in range(3):
        single = fields(predictor.predict(start, Script(scripts[row : row + 1]), 1.0))
        for key, value in single.items():
            np.testing.assert_array_equal(value[0], whole[key][row], err_msg=key)


def test_the_same_question_has_the_same_answer_whatever_was_asked_between(
    op3: RobotDescription,
) -> None:
    start, predictor = scene(op3).start, RolloutPredictor(op3)
    first = predictor.predict(start, Script(three(op3)), 1.0)
    predictor.predict(start, Script(three(op3)[::-1] + 0.1), 1.0)
    again = predictor.predict(start, Script(three(op3)), 1.0)
    for key, value in fields(first).items():
        np.testing.assert_array_equal(value, fields(again)[key], err_msg=key)


def test_an_outcome_stays_when_the_next_is_predicted(op3: RobotDescription) -> None:
    start, predictor = scene(op3).start, RolloutPredictor(op3)
    first = predictor.predict(start, Script(three(op3)), 1.0)
    kept = {key: value.copy() for key, value in fields(first).items()}
    predictor.predict(start, Script(three(op3)[::-1] + 0.1), 1.0)
    for key, value in fields(first).items():
        np.testing.assert_array_equal(value, kept[key], err_msg=key)


def test_rollouts_end_one_by_one(human: RobotDescription) -> None:
    class Staggered(Script):
        def step(self, state: PolicyInput, dt: float) -> Array:
            goals = super().step(state, dt)
            self.done = np.array([self._tick > end for end in (5, 15, 25)])
            return goals

    start = scene(human).start
    outcome = RolloutPredictor(human).predict(start, Staggered(three(human)), 1.0)
    np.testing.assert_allclose(outcome.duration * human.rate_hz, [5, 15, 25])
    assert not outcome.fell.any()


@pytest.mark.parametrize("name", ["op3", "human"])
def test_a_fall_is_reported_and_ends_its_rollout_only(
    name: str, request: pytest.FixtureRequest
) -> None:
    robot: RobotDescription = request.getfixturevalue(name)
    start = scene(robot).start
    base = start.observation.base
    assert base is not None
    ticks = round(1.2 * robot.rate_hz)
    stand = np.repeat(robot.stance[None], ticks, axis=0)
    tip = stand.copy()
    ankles = [j for j, joint in enumerate(robot.joints.names) if "ank" in joint and "pit" in joint]
    tip[:, ankles] = robot.joints.upper[ankles]
    thrown = replace(base, linear_velocity=np.array([1.5, 0.0, 0.0]))
    pushed = replace(start, observation=replace(start.observation, base=thrown))
    predictor = RolloutPredictor(robot)
    outcome = predictor.predict(pushed, Script(np.stack([stand, tip])), 2.0)
    assert outcome.fell.all()
    assert (outcome.duration < ticks / robot.rate_hz).all()
    still = predictor.predict(start, Script(np.stack([stand[:40], stand[:40]])), 2.0)
    assert not still.fell.any()


def test_a_rollout_that_never_ends_stops_at_the_horizon(human: RobotDescription) -> None:
    start = scene(human).start
    script = Script(np.repeat(human.stance[None, None], 10_000, axis=1))
    outcome = RolloutPredictor(human).predict(start, script, 0.2)
    assert outcome.duration[0] == pytest.approx(0.2)
    assert not script.done.any()


def test_a_prediction_never_touches_the_live_twin(op3: RobotDescription) -> None:
    world = scene(op3)
    twin = world.twin
    before = (twin.save().physics.tobytes(), twin.model.actuator_gainprm.tobytes(), twin.time)
    predictor = RolloutPredictor(op3)
    predictor.predict(world.start, world.script, 1.0)
    assert (
        twin.save().physics.tobytes(),
        twin.model.actuator_gainprm.tobytes(),
        twin.time,
    ) == before
    assert predictor.stopwatch.count == 1


def test_ground_that_was_felt_is_as_good_as_known_ground(human: RobotDescription) -> None:
    start = scene(human)
    rise = np.tan(np.radians(4.0))
    base = start.start.observation.base
    assert base is not None
    base = replace(base, position=base.position + np.array([0.0, 0.0, 2.0 * rise]))
    observation = replace(start.start.observation, base=base)
    known = replace(start.start, observation=observation)
    felt = replace(known, ground=(2.0 * rise, rise, 0.0))
    slope = RolloutPredictor(human, ground=Ground(slope=4.0, start=-2.0))
    truth = slope.predict(known, start.script, 1.0)
    outcome = RolloutPredictor(human).predict(felt, start.script, 1.0)
    np.testing.assert_allclose(outcome.feet, truth.feet, atol=1e-6)
    np.testing.assert_allclose(outcome.base_position, truth.base_position, atol=1e-6)
