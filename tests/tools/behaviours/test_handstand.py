"""The human on its hands: the same controllers on a body with other ends to stand on."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

from tests.tools.conftest import Windup
from windup.control.footprints.footprints import read_footprints
from windup.robots import RobotDescription, load_robot
from windup.tools.behaviours.directed import build_checks, feet_of


@pytest.fixture(scope="module")
def handstand() -> RobotDescription:
    return load_robot("human_handstand")


def test_it_is_the_human_upside_down(handstand: RobotDescription, human: RobotDescription) -> None:
    upright = np.zeros(len(human.joints))
    upright[[human.joints.names.index(name) for name in ("l_shoulder", "r_shoulder")]] = np.pi
    there, here = segments(human, upright), segments(handstand, np.zeros(len(handstand.joints)))
    assert sum(mass for mass, _ in here.values()) == pytest.approx(88.29, abs=5e-3)
    arms = {f"{side}_{part}" for side in "lr" for part in ("lower_arm", "hand")}
    assert here.keys() == there.keys() | arms
    for name in there.keys() - arms:
        assert here[name][0] == there[name][0]
        np.testing.assert_allclose(here[name][1], there[name][1] * [-1.0, 1.0, -1.0], atol=1e-5)


def segments(robot: RobotDescription, pose: np.ndarray) -> dict[str, tuple[float, np.ndarray]]:
    """Return mass and centre of mass (3,) of each body, seen from the upper torso."""
    model = robot.spec().compile()
    data = mujoco.MjData(model)
    data.qpos[7:] = pose
    mujoco.mj_kinematics(model, data)
    middle = data.body("upper_torso").xpos
    return {
        model.body(k).name: (float(model.body_mass[k]), data.xipos[k] - middle)
        for k in range(1, model.nbody)
    }


def test_it_starts_with_its_weight_over_flat_hands(handstand: RobotDescription) -> None:
    model = handstand.spec().compile()
    data = mujoco.MjData(model)
    data.qpos[7:] = handstand.stance
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    hands = [data.site(hand.site) for hand in handstand.feet]
    middle = np.mean([hand.xpos for hand in hands], axis=0)
    np.testing.assert_allclose(data.subtree_com[1, :2], middle[:2], atol=1e-3)
    for hand in hands:
        np.testing.assert_allclose(hand.xmat.reshape(3, 3), np.eye(3), atol=1e-3)


def test_it_steps_with_a_hand_where_it_is_told(shell: Windup) -> None:
    where = ("--to", "0.1", "0.26", "--state", "estimated", "--json", "-")
    ran = shell("step", "human_handstand", "--foot", "left", *where)
    (fall,) = ran.json["falls"]
    assert (ran.status, fall["foot"], ran.json["reason"]) == (0, "left_hand", "done")
    assert np.hypot(fall["place"]["x"] - 0.1, fall["place"]["y"] - 0.26) < 0.03


def test_a_push_makes_it_step_with_a_hand(shell: Windup) -> None:
    push = ("--impulse", "30", "--at", "0.5", "--way", "predictive", "--json", "-")
    ran = shell("push", "human_handstand", *push)
    assert (ran.status, ran.json["steps"]) == (0, 1)


def test_six_steps_forward_are_within_reach(handstand: RobotDescription) -> None:
    path = Path(__file__).parents[3] / "docs" / "handstand.toml"
    prints = read_footprints(path, feet_of(handstand))
    build_checks(handstand).check(prints)
    assert len(prints) == 6
    assert all(one.place[0] >= 0.1 for one in prints)
