from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.small_world import AIR, CONTACTS, JOINTS, L_TOE, R_HEEL, R_TOE, N, gait, policy_state
from windup.control.limit_cycle.policy import StepPolicy
from windup.control.pose_graph.gait import Gait
from windup.control.pose_graph.goal_limits import GoalLimits
from windup.control.pose_graph.pose_tracker import PoseTracker, TrackerState
from windup.control.pose_graph.torso_servo import TorsoServo
from windup.hal.joints import Array

DT = 0.01

TIMED = """
title = "timed"
[[state]]
name = "A"
pose = { l_hip = 10 }
until = { time = 0.03 }
[[state]]
name = "B"
pose = { l_hip = 20 }
until = { time = 0.02 }
ends_step = true
"""

SENSED = """
title = "sensed"
[[state]]
name = "A"
until = { contact = "%s", timeout = 0.05 }
[[state]]
name = "B"
until = { time = 1.0 }
"""

WALK = """
title = "walk"
mirror = true
[[state]]
name = "A"
pose = { l_hip = 5, l_knee = 20 }
until = { contact = "right_foot", timeout = 0.06 }
stance = "right_foot"
[[state]]
name = "B"
pose = { l_hip = -5 }
until = { time = 0.03 }
stance = "right_foot"
ends_step = true
[[perturbation]]
name = "stride"
stance = "right_foot"
pose = { l_hip = 1, waist = 0.5 }
hold = 0.01
[[perturbation]]
name = "turn"
pose = { r_hip = 2 }
opposite = true
"""


def tracker(graph: Gait, size: int = 1) -> PoseTracker:
    return PoseTracker(graph, CONTACTS, np.zeros((size, len(graph.perturbations))))


def states(subject: PoseTracker, contacts: list[Array]) -> list[int]:
    """Return the state in each tick; the first tick takes no transition, as in the loop."""
    seen = []
    for tick, sensed in enumerate(contacts):
        if tick:
            subject.advance(sensed[None])
        subject.step(policy_state([sensed]), DT)
        seen.append(int(subject.now.state[0]))
    return seen


def test_a_timed_state_is_held_for_its_time(tmp_path: Path) -> None:
    assert states(tracker(gait(tmp_path, TIMED)), [AIR] * 8) == [0, 0, 0, 1, 1, 0, 0, 0]


def test_a_step_is_counted_where_a_state_ends_it(tmp_path: Path) -> None:
    subject = tracker(gait(tmp_path, TIMED))
    states(subject, [AIR] * 6)
    assert subject.now.steps[0] == 1
    states(subject, [AIR] * 10)
    assert subject.now.steps[0] == 3


def test_the_goal_is_the_pose_of_the_state(tmp_path: Path) -> None:
    subject = tracker(gait(tmp_path, TIMED))
    goals = subject.step(policy_state([AIR]), DT)
    np.testing.assert_allclose(goals, np.radians([[0, 10, 0, 0, 0]]))


def test_a_sensor_ends_its_state(tmp_path: Path) -> None:
    subject = tracker(gait(tmp_path, SENSED % "right_foot"))
    assert states(subject, [AIR, AIR, R_TOE, AIR]) == [0, 0, 1, 1]


def test_a_sensor_that_is_already_on_ends_its_state_at_once(tmp_path: Path) -> None:
    subject = tracker(gait(tmp_path, SENSED % "right_foot"))
    assert states(subject, [R_TOE, R_TOE]) == [0, 1]


def test_a_sensor_state_ends_at_its_time_out_all_the_same(tmp_path: Path) -> None:
    subject = tracker(gait(tmp_path, SENSED % "right_foot"))
    assert states(subject, [AIR] * 7) == [0, 0, 0, 0, 0, 1, 1]


def test_without_a_time_out_a_sensor_state_waits_for_ever(tmp_path: Path) -> None:
    text = SENSED.replace(", timeout = 0.05", "") % "right_foot"
    assert states(tracker(gait(tmp_path, text)), [AIR] * 2000)[-1] == 0


@pytest.mark.parametrize(
    ("waits_for", "sensed", "state"),
    [
        ("right_foot", R_HEEL, 1),
        ("right_foot", R_TOE, 1),
        ("right_foot", L_TOE, 0),
        ("r_heel", R_HEEL, 1),
        ("r_heel", R_TOE, 0),
    ],
)
def test_a_transition_names_one_point_or_a_whole_foot(
    tmp_path: Path, waits_for: str, sensed: Array, state: int
) -> None:
    assert states(tracker(gait(tmp_path, SENSED % waits_for)), [AIR, sensed])[-1] == state


def test_a_graph_without_a_loop_ends_and_stays(tmp_path: Path) -> None:
    subject = tracker(gait(tmp_path, TIMED.replace('"timed"', '"timed"\nloop = false')))
    assert states(subject, [AIR] * 4)[-1] == 1
    assert not subject.finished()[0]
    assert states(subject, [AIR] * 20)[-1] == 1
    assert subject.finished()[0]
    assert subject.now.steps[0] == 0, "nobody left the last state"


def test_a_periodic_graph_is_never_finished(tmp_path: Path) -> None:
    subject = tracker(gait(tmp_path, TIMED))
    states(subject, [AIR] * 30)
    assert not subject.finished()[0]


def test_scalings_move_poses_and_hold_times(tmp_path: Path) -> None:
    subject = tracker(gait(tmp_path, WALK))
    subject.rescale(np.array([[2.0, 0.0]]))
    goals = subject.step(policy_state([AIR]), DT)
    np.testing.assert_allclose(goals, np.radians([[1, 7, 20, 0, 0]]))
    np.testing.assert_allclose(subject.hold[0], [np.inf, 0.05, np.inf, 0.05])


def test_a_hold_time_cannot_be_scaled_below_nothing(tmp_path: Path) -> None:
    subject = tracker(gait(tmp_path, WALK))
    subject.rescale(np.array([[-100.0, 0.0]]))
    assert subject.hold[0, 1] == 0.0


def test_restart_goes_back_to_the_first_state(tmp_path: Path) -> None:
    subject = tracker(gait(tmp_path, TIMED))
    states(subject, [AIR] * 6)
    subject.restart()
    assert (subject.now.state[0], subject.now.elapsed[0], subject.now.steps[0]) == (0, 0.0, 0)
    np.testing.assert_allclose(
        subject.step(policy_state([AIR]), DT), np.radians([[0, 10, 0, 0, 0]])
    )


def test_a_remembered_place_does_not_move_with_its_tracker(tmp_path: Path) -> None:
    subject = tracker(gait(tmp_path, TIMED))
    states(subject, [AIR] * 2)
    then = subject.now
    states(subject, [AIR] * 6)
    assert then.elapsed[0] == pytest.approx(0.02)


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Gait:
    return gait(tmp_path_factory.mktemp("walk"), WALK)


@given(
    scale=st.lists(st.tuples(*[st.floats(-5, 5)] * 2), min_size=1, max_size=6),
    touches=st.lists(st.integers(0, 15), min_size=1, max_size=40),
    pitch=st.floats(-0.5, 0.5),
    servo=st.booleans(),
)
def test_a_batch_is_as_many_single_robots(
    walk: Gait,
    scale: list[tuple[float, float]],
    touches: list[int],
    pitch: float,
    servo: bool,
) -> None:
    scales = np.array(scale)
    torso = TorsoServo(joint=0, angle=0.1, ratio=0.05) if servo else None
    whole = PoseTracker(walk, CONTACTS, scales, None, torso)
    single = [PoseTracker(walk, CONTACTS, row[None], None, torso) for row in scales]
    for tick, bits in enumerate(touches):
        # Every robot of the batch feels its own ground.
        felt = [
            np.array([9.0 * ((bits + i) >> k & 1) for k in range(4)]) for i in range(len(scales))
        ]
        if tick:
            ended = whole.advance(np.array(felt))
            alone = [bool(one.advance(own[None])[0]) for one, own in zip(single, felt, strict=True)]
            assert ended.tolist() == alone
        together = whole.step(policy_state(felt, pitch, 0.3), DT)
        apart = [
            one.step(policy_state([own], pitch, 0.3), DT)[0]
            for one, own in zip(single, felt, strict=True)
        ]
        np.testing.assert_allclose(together, np.array(apart), rtol=0.0, atol=1e-14)
    assert whole.now.steps.tolist() == [int(one.now.steps[0]) for one in single]


def test_copies_of_a_tracker_start_where_it_is(tmp_path: Path) -> None:
    graph = gait(tmp_path, TIMED)
    subject = tracker(graph)
    states(subject, [AIR] * 4)
    copies = PoseTracker(graph, CONTACTS, np.zeros((3, 0)), subject.now.repeat(3))
    assert copies.now.state.tolist() == [1, 1, 1]
    copies.step(policy_state([AIR] * 3), DT)
    assert subject.now.elapsed[0] == pytest.approx(0.01), "the copies' time is their own"


def test_a_step_policy_is_done_when_the_step_ends(tmp_path: Path) -> None:
    policy = StepPolicy(tracker(gait(tmp_path, TIMED), 2), GoalLimits(JOINTS))
    done = []
    for _ in range(7):
        policy.step(policy_state([AIR] * 2), DT)
        done.append(policy.done.tolist())
    assert done == [[False, False]] * 5 + [[True, True]] * 2


def test_a_step_policy_asks_for_nothing_that_the_guard_would_clamp(tmp_path: Path) -> None:
    subject = tracker(gait(tmp_path, WALK))
    subject.rescale(np.array([[500.0, -500.0]]))
    goals = StepPolicy(subject, GoalLimits(JOINTS)).step(policy_state([AIR]), DT)[0]
    assert goals.shape == (N,)
    assert goals[1] == JOINTS.upper[1]
    assert ((goals >= JOINTS.lower) & (goals <= JOINTS.upper)).all()


def test_a_step_policy_takes_late_scalings_at_their_time(tmp_path: Path) -> None:
    graph = gait(tmp_path, TIMED.replace("0.03", "1.0") + PERTURBATION)
    policy = StepPolicy(tracker(graph), GoalLimits(JOINTS))
    policy.rescale_at(0.02, np.array([[10.0]]))
    hips = [float(policy.step(policy_state([AIR]), DT)[0, 1]) for _ in range(4)]
    np.testing.assert_allclose(np.degrees(hips), [10, 10, 20, 20])


PERTURBATION = """
[[perturbation]]
name = "more"
pose = { l_hip = 1 }
"""


def test_begin_is_the_first_state_of_every_copy() -> None:
    start = TrackerState.begin(3)
    assert start.state.tolist() == start.steps.tolist() == [0, 0, 0]
    assert start.elapsed.tolist() == [0.0, 0.0, 0.0]
