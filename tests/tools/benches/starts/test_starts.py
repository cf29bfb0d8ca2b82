"""Random starts: where robots are put, what is wrong with them, and what comes of it."""

from pathlib import Path

import numpy as np
import pytest

from windup.control.kinematics.legs import legs_of
from windup.robots import load_robot
from windup.tools.benches.random_starts import measure_starts
from windup.tools.benches.starts.faults import FaultyJoints
from windup.tools.benches.starts.postures import KINDS, kinds_of, on_feet, random_posture
from windup.tools.benches.starts.trial import Start, try_start


def test_a_robot_on_its_feet_has_flat_level_soles_under_its_weight() -> None:
    op3 = load_robot("op3")
    rng = np.random.default_rng(3)
    pose, turn = on_feet(op3, op3.stance + np.radians(4.0) * rng.normal(size=20))
    legs = legs_of(
        op3.spec().compile(), op3.base, [foot.body for foot in op3.feet], op3.joints, op3.stance
    )
    assert legs is not None
    normals, middles = legs.soles(pose[None])
    up = turn.inv().apply([0.0, 0.0, 1.0])
    assert (normals[0] @ up) == pytest.approx([1.0, 1.0], abs=2e-3)
    assert np.ptp(middles[0] @ up) < 0.005


def test_the_same_seed_is_the_same_posture_and_others_differ() -> None:
    duck = load_robot("duck")
    one, again, other = (
        random_posture(duck, "hanging", np.random.default_rng(seed)) for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(one.pose, again.pose)
    assert not np.allclose(one.pose, other.pose)


def test_who_cannot_sit_does_not() -> None:
    assert kinds_of(load_robot("op3")) == KINDS
    assert "sitting" not in kinds_of(load_robot("duck"))


def test_a_wrong_sign_and_swapped_ids_stand_in_a_copy_of_the_file(tmp_path: Path) -> None:
    op3 = load_robot("op3")
    knees = op3.joints.index("l_knee"), op3.joints.index("r_knee")
    flipped = load_robot(FaultyJoints("sign", knees[:1]).folder(op3, tmp_path / "a"))
    swapped = load_robot(FaultyJoints("swap", knees).folder(op3, tmp_path / "b"))
    for joint, (right, wrong, other) in enumerate(
        zip(op3.servos, flipped.servos, swapped.servos, strict=True)
    ):
        assert right is not None and wrong is not None and other is not None
        assert wrong.sign == (-1 if joint == knees[0] else right.sign)
        partner = op3.servos[knees[1 - knees.index(joint)]] if joint in knees else right
        assert partner is not None and other.id == partner.id


def test_faults_of_the_file_are_in_legs() -> None:
    duck = load_robot("duck")
    for seed in range(20):
        broken = FaultyJoints.random(duck, "swap", np.random.default_rng(seed))
        names = [duck.joints.names[joint] for joint in broken.joints]
        assert len(set(names)) == 2 and not any("head" in name or "neck" in name for name in names)


@pytest.mark.parametrize(
    ("start", "outcome"),
    [
        (Start("duck", "squatting", 1), "done"),
        (Start("op3", "hanging", 1), "done"),
        (Start("op3", "lying", 1), "done"),
        (Start("op3", "sitting", 1), "done"),
        (Start("duck", "lying", 1), "refused"),
        (Start("op3", "standing", 4, "sign"), "first motion"),
        (Start("duck", "hanging", 0, "motor"), "first motion"),
        (Start("op3", "hanging", 4, "jam"), "first motion"),
    ],
    ids=lambda value: f"{value.robot}-{value.kind}-{value.fault}" if value != str(value) else "",
)
def test_what_comes_of_a_start(start: Start, outcome: str) -> None:
    row = try_start(start)
    assert row["outcome"] == outcome, row["said"]
    assert row["told"] is (True if start.kind in ("sitting", "lying") else None)
    if start.fault is not None:
        assert any(name in row["said"] for name in row["joints"])
        assert row["moved"] < 15.0


def test_the_bench_counts_sound_starts_and_such_with_a_fault() -> None:
    result = measure_starts("duck", starts=4, seed=2)
    assert (result["starts"], result["down"], result["told"]) == (4, 1, 1)
    assert result["false_refusals"] == result["falls"] == 0
    for fault in ("sign", "swap", "jam", "motor"):
        row = result[fault]
        assert row["starts"] == row["caught"] + row["unseen"] + row["late"] == 1
