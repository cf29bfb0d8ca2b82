"""The first motion after arming, on five joints that are where they are told to be, or not."""

from collections.abc import Callable
from math import degrees, radians

import numpy as np
import pytest

from tests.small_world import JOINTS, N, observation
from windup.control.motions.first_motion import CLOSE, SETTLING, FirstMotion
from windup.control.motions.play import PoseHolder
from windup.hal.command import JointCommand
from windup.hal.errors import FirstMotionError
from windup.hal.joints import Array
from windup.hal.observation import Observation

TICK = 0.008
SPEED, WEAK = 0.6, np.array([0.3, 0.6, 0.6, 0.6, 0.6])
L_KNEE, R_KNEE = JOINTS.index("l_knee"), JOINTS.index("r_knee")
BENT = JOINTS.array({"l_knee": 1.0, "r_knee": 0.5})

Joint = Callable[[Array], Array]
"""Where joints (n,) rad are for goals (n,) rad."""


def follows(goal: Array) -> Array:
    return goal.copy()


def motion() -> FirstMotion:
    return FirstMotion(JOINTS, WEAK, SPEED, lag=0.25)


class Still:
    """A controller of a user's own: it holds a pose from its first command on."""

    def __init__(self, pose: Array) -> None:
        self.pose, self.resets = pose, 0

    def reset(self, observation: Observation) -> None:
        self.resets += 1

    def step(self, observation: Observation, dt: float) -> JointCommand:
        return JointCommand.hold(JOINTS, self.pose)


def run(
    first: FirstMotion,
    controller: PoseHolder | Still,
    start: Array | None = None,
    joint: Joint = follows,
    seconds: float = 5.0,
) -> list[tuple[bool, JointCommand]]:
    """Return whether the first motion was still under way, and the command, at each tick."""
    position = np.zeros(N) if start is None else start
    approach = first.before(controller, upright=True)
    approach.reset(observation(0.0, position))
    ticks = []
    for tick in range(round(seconds / TICK)):
        command = approach.step(observation(tick * TICK, position), TICK)
        ticks.append((approach.active, command))
        position = joint(command.position)
    return ticks


def test_goals_go_there_at_no_more_than_the_speed_and_stay() -> None:
    ticks = run(motion(), PoseHolder(JOINTS, BENT))
    goals = np.array([command.position for _, command in ticks])
    assert np.abs(np.diff(goals, axis=0)).max() <= SPEED * TICK * 1.001
    assert goals[0] == pytest.approx(np.zeros(N))
    under_way = sum(active for active, _ in ticks) * TICK
    assert under_way == pytest.approx(1.5 * 1.0 / SPEED + SETTLING, abs=2 * TICK)
    assert goals[round(under_way / TICK) :] == pytest.approx(
        np.broadcast_to(BENT, (len(ticks) - round(under_way / TICK), N))
    )


def test_stiffness_rises_from_its_share_to_the_whole() -> None:
    ticks = run(motion(), PoseHolder(JOINTS, BENT))
    stiffness = np.array([command.stiffness for _, command in ticks])
    assert stiffness[0] == pytest.approx(WEAK * JOINTS.stiffness)
    assert (np.diff(stiffness, axis=0) >= 0.0).all()
    assert stiffness[-1] == pytest.approx(JOINTS.stiffness)


def test_a_controller_that_holds_a_pose_is_taken_to_its_first_command_and_begins_there() -> None:
    controller = Still(BENT)
    first = motion()
    ticks = run(first, controller)
    assert ticks[0][1].position == pytest.approx(np.zeros(N))
    assert ticks[-1][1].position == pytest.approx(BENT)
    assert controller.resets == 2 and not first.due


def test_a_load_that_holds_joints_back_makes_no_jump_at_the_end() -> None:
    ticks = run(motion(), PoseHolder(JOINTS, BENT), joint=lambda goal: goal - radians(6.0))
    goals = np.array([command.position for _, command in ticks])
    assert np.abs(np.diff(goals, axis=0)).max() <= SPEED * TICK * 1.001


def test_a_robot_that_is_there_only_gets_stiff_and_still_has_its_first_motion_before_it() -> None:
    first = motion()
    ticks = run(first, PoseHolder(JOINTS, BENT), start=BENT + 0.5 * CLOSE)
    assert sum(active for active, _ in ticks) * TICK < 1.0
    assert first.due and (first.share == 1.0).all()
    away = np.abs(np.array([command.position for _, command in ticks]) - BENT)
    assert away.max() <= 0.5 * CLOSE + 1e-9
    # The next one goes to a pose far away: slowly, and no weaker than the robot is by now.
    ticks = run(first, PoseHolder(JOINTS, np.zeros(N)), start=BENT)
    assert ticks[0][0] and not first.due
    assert ticks[0][1].stiffness == pytest.approx(JOINTS.stiffness)


def test_once_it_is_over_controllers_are_left_alone_until_torque_comes_on_again() -> None:
    first = motion()
    run(first, PoseHolder(JOINTS, BENT))
    ticks = run(first, Still(np.zeros(N)), start=BENT)
    assert not any(active for active, _ in ticks)
    assert ticks[0][1].position == pytest.approx(np.zeros(N))
    first.begin()
    assert run(first, Still(np.zeros(N)), start=BENT)[0][0]


def test_a_joint_that_does_not_move_is_named_before_its_goal_is_far() -> None:
    goals: list[float] = []

    def jammed(goal: Array) -> Array:
        goals.append(float(goal[L_KNEE]))
        return np.where(np.arange(N) == L_KNEE, 0.0, goal)

    with pytest.raises(FirstMotionError, match=r"l_knee does not follow: is it blocked"):
        run(motion(), PoseHolder(JOINTS, BENT), joint=jammed)
    assert degrees(goals[-1]) < 15.0


def test_a_joint_that_goes_next_to_nothing_of_a_short_way_is_named_at_its_end() -> None:
    with pytest.raises(FirstMotionError, match="l_knee does not follow"):
        run(
            motion(),
            PoseHolder(JOINTS, JOINTS.array({"l_knee": radians(12.0)})),
            joint=lambda goal: 0.1 * goal,
        )


def test_a_joint_that_turns_the_other_way_is_named() -> None:
    with pytest.raises(FirstMotionError, match=r"l_knee turns the other way .*: is its sign right"):
        run(
            motion(),
            PoseHolder(JOINTS, BENT),
            joint=lambda goal: np.where(np.arange(N) == L_KNEE, -goal, goal),
        )


def test_a_joint_that_moves_in_place_of_another_is_named_with_it() -> None:
    def swapped(goal: Array) -> Array:
        there = goal.copy()
        there[[L_KNEE, R_KNEE]] = goal[[R_KNEE, L_KNEE]]
        return there

    with pytest.raises(
        FirstMotionError, match=r"l_knee was told to move and r_knee moved: are their ids swapped"
    ):
        run(motion(), PoseHolder(JOINTS, JOINTS.array({"l_knee": 1.0})), joint=swapped)


def test_a_joint_that_runs_away_from_where_it_should_stay_is_named() -> None:
    place = [0.0]

    def runs_away(goal: Array) -> Array:
        place[0] += 0.01
        return np.where(np.arange(N) == 0, place[0], goal)

    with pytest.raises(FirstMotionError, match=r"waist turned [0-9]+ degrees though it was told"):
        run(motion(), PoseHolder(JOINTS, BENT), joint=runs_away)


def test_a_joint_that_moves_but_stays_far_behind_is_named() -> None:
    with pytest.raises(FirstMotionError, match=r"l_knee is 1[0-9] degrees behind its goal"):
        run(motion(), PoseHolder(JOINTS, BENT), joint=lambda goal: 0.5 * goal)


def test_one_wrong_reading_is_no_fault() -> None:
    ticks = [0]

    def glitch(goal: Array) -> Array:
        ticks[0] += 1
        return goal + (1.0 if ticks[0] == 50 else 0.0)

    assert run(motion(), PoseHolder(JOINTS, BENT), joint=glitch)[-1][0] is False


def test_a_joint_that_is_silent_for_a_while_is_not_judged_by_its_old_reading() -> None:
    first = motion()
    approach = first.before(PoseHolder(JOINTS, BENT), upright=True)
    silent = np.where(np.arange(N) == L_KNEE, 0.1, 0.0)
    approach.reset(observation(0.0))
    position = np.zeros(N)
    for tick in range(round(5.0 / TICK)):
        age = silent if 1.0 < tick * TICK < 1.6 else np.zeros(N)
        command = approach.step(observation(tick * TICK, position, age=age), TICK)
        position = np.where(age > 0.0, position, command.position)
    assert not approach.active


def test_a_joint_that_runs_away_just_after_it_is_named_too() -> None:
    place = [0.0]

    def runs_away_later(goal: Array) -> Array:
        place[0] += 0.01 if goal[L_KNEE] == pytest.approx(1.0) and place[0] < 3.0 else 0.0
        return np.where(np.arange(N) == 0, place[0] * (place[0] > 0.45), goal)

    with pytest.raises(FirstMotionError, match="waist turned"):
        run(motion(), PoseHolder(JOINTS, BENT), joint=runs_away_later)


def test_a_controller_that_moves_fast_afterwards_is_not_judged() -> None:
    class Jumps(Still):
        def step(self, observation: Observation, dt: float) -> JointCommand:
            there = self.pose if observation.time < 3.0 else np.zeros(N)
            return JointCommand.hold(JOINTS, there)

    ticks = run(motion(), Jumps(BENT), joint=lambda goal: 0.9 * goal)
    assert ticks[-1][1].position == pytest.approx(np.zeros(N))


def test_a_robot_that_is_stiff_leaves_it_to_a_controller_where_that_begins() -> None:
    first = motion()
    run(first, Still(np.zeros(N)))
    assert first.made and first.due
    ticks = run(first, Still(BENT), seconds=0.1)
    assert not ticks[0][0] and (ticks[0][1].position == BENT).all()


def test_a_way_of_a_stiff_robot_begins_at_its_goal_for_under_load_it_hangs_behind() -> None:
    first = motion()
    run(first, Still(np.zeros(N)))
    sagging = np.full(N, -0.04)
    ticks = run(first, PoseHolder(JOINTS, BENT), start=sagging, seconds=0.1)
    assert ticks[0][0]
    assert ticks[0][1].position == pytest.approx(np.zeros(N), abs=1e-3)


def test_a_pose_after_the_first_motion_begins_at_the_last_goal_too() -> None:
    first = motion()
    run(first, PoseHolder(JOINTS, BENT))
    assert not first.due
    ticks = run(first, PoseHolder(JOINTS, BENT), joint=lambda _: BENT - 0.08, start=BENT - 0.08)
    assert all(command.position == pytest.approx(BENT) for _, command in ticks)
