from pathlib import Path

import numpy as np
import pytest

from tests.small_world import CONTACTS, gait
from windup.control.pose_graph.pose_graph import FOREVER
from windup.hal.errors import ConfigError, UnknownNameError

GAIT = """
title = "Walk"
mirror = true
columns = ["l_hip", "l_knee"]

[pose]
r_knee = 30

[[state]]
name = "swing"
pose = [10, 40]
until = { contact = "right_foot", timeout = 2.0 }
stance = "right_foot"

[[state]]
name = "land"
pose = { l_hip = -10 }
until = { time = 0.25 }
stance = "right_foot"
ends_step = true

[[perturbation]]
name = "hip"
stance = "right_foot"
pose = { r_hip = 2 }

[[perturbation]]
name = "turn"
stance = "right_foot"
pose = { waist = 1 }
opposite = true

[[perturbation]]
name = "slow"
states = ["land"]
hold = 0.1
"""


def test_a_gait_file_becomes_a_graph_in_radians_and_seconds(tmp_path: Path) -> None:
    graph = gait(tmp_path, GAIT).graph
    np.testing.assert_allclose(np.degrees(graph.pose[0]), [0, 10, 40, 0, 30], atol=1e-12)
    np.testing.assert_allclose(np.degrees(graph.pose[1]), [0, -10, 0, 0, 30], atol=1e-12)
    np.testing.assert_array_equal(graph.hold[:2], [FOREVER, 0.25])
    np.testing.assert_array_equal(graph.timeout[:2], [2.0, FOREVER])
    assert graph.ends_step.tolist() == [False, True, False, True]


def test_entries_of_one_perturbation_add_up(tmp_path: Path) -> None:
    slow = 'name = "slow"\nstates = ["land"]\n'
    more = f"[[perturbation]]\n{slow.replace('land', 'swing')}pose = {{ r_hip = 3 }}\n"
    subject = gait(tmp_path, GAIT + more)
    assert subject.perturbations == ("hip", "turn", "slow")
    assert subject.hold_change[2][1] == pytest.approx(0.1)
    assert np.degrees(np.abs(subject.pose_change[2][0]).max()) == pytest.approx(3.0)


def test_mirror_adds_the_steps_of_the_other_side(tmp_path: Path) -> None:
    graph = gait(tmp_path, GAIT).graph
    assert graph.names == ("swing", "land", "swing'", "land'")
    assert graph.successor.tolist() == [1, 2, 3, 0]
    np.testing.assert_allclose(np.degrees(graph.pose[2]), [0, 0, 30, -10, 40], atol=1e-12)
    assert graph.stance.tolist() == [1, 1, 0, 0]
    np.testing.assert_array_equal(graph.sensors[0], CONTACTS.mask("right_foot"))
    np.testing.assert_array_equal(graph.sensors[2], CONTACTS.mask("left_foot"))
    np.testing.assert_array_equal(graph.timeout, [2.0, FOREVER, 2.0, FOREVER])


def test_a_perturbation_of_one_stance_is_mirrored_on_the_other(tmp_path: Path) -> None:
    change = np.degrees(gait(tmp_path, GAIT).relative("hip").pose)
    np.testing.assert_allclose(change[0], [0, 0, 0, 2, 0], atol=1e-12)
    np.testing.assert_allclose(change[2], [0, -2, 0, 0, 0], atol=1e-12)


def test_an_opposite_perturbation_is_the_negative_mirror_image(tmp_path: Path) -> None:
    change = np.degrees(gait(tmp_path, GAIT).relative("turn").pose)
    np.testing.assert_allclose(change[:, 0], [1, 1, -1, -1], atol=1e-12)


def test_a_perturbation_of_hold_times_leaves_sensor_states_alone(tmp_path: Path) -> None:
    change = gait(tmp_path, GAIT).relative("slow")
    np.testing.assert_allclose(change.hold, [0.0, 0.1, 0.0, 0.1])
    assert not change.pose.any()
    everywhere = gait(tmp_path, GAIT.replace('states = ["land"]\n', "")).relative("slow")
    np.testing.assert_allclose(everywhere.hold, [0.0, 0.1, 0.0, 0.1])


def test_next_leads_anywhere_and_a_line_has_an_end(tmp_path: Path) -> None:
    text = GAIT.replace("mirror = true", "loop = false")
    assert gait(tmp_path, text).graph.successor.tolist() == [1, 1]
    text = GAIT.replace("mirror = true", "").replace("ends_step = true", 'next = "land"')
    assert gait(tmp_path, text).graph.successor.tolist() == [1, 1]


def test_the_name_of_a_gait_is_its_files(tmp_path: Path) -> None:
    subject = gait(tmp_path, GAIT, "stroll")
    assert subject.name == "stroll"
    assert subject.perturbations == ("hip", "turn", "slow")
    with pytest.raises(UnknownNameError, match="unknown perturbation 'hipp'; did you mean 'hip'"):
        subject.index("hipp")


BAD = {
    "unknown key": ("title =", "titel =", "unknown key 'titel'; did you mean 'title'?"),
    "unknown key in a state": (
        "ends_step = true",
        "end_step = true",
        "unknown key 'state[1].end_step'; did you mean 'ends_step'?",
    ),
    "wrong type": ("time = 0.25", 'time = "long"', "state[1].until.time: Expected `float | null`"),
    "not TOML": ("[pose]", "[pose", "not TOML: "),
    "joint of a pose": (
        "{ l_hip = -10 }",
        "{ l_hipp = -10 }",
        "state.land.pose: unknown joint 'l_hipp'; did you mean 'l_hip'? "
        "known: l_hip, l_knee, r_hip, r_knee, waist",
    ),
    "joint of the common pose": (
        "r_knee = 30",
        "r_kne = 30",
        "pose: unknown joint 'r_kne'; did you mean 'r_knee'?",
    ),
    "joint of a perturbation": (
        "{ r_hip = 2 }",
        "{ rhip = 2 }",
        "perturbation.hip: unknown joint 'rhip'; did you mean 'r_hip'?",
    ),
    "joint of a column": (
        'columns = ["l_hip"',
        'columns = ["l_hop"',
        "state.swing.pose: unknown joint 'l_hop'; did you mean 'l_hip'?",
    ),
    "pose outside": (
        "[10, 40]",
        "[10, 140]",
        "state.swing.pose.l_knee: 140 degrees is outside the joint's limits 0.0 .. 114.6",
    ),
    "common pose outside": (
        "r_knee = 30",
        "r_knee = -30",
        "r_knee: -30 degrees is outside the joint's limits 0.0 .. 114.6",
    ),
    "pose that is no number": ("[10, 40]", "[10, nan]", "state[0].pose[1]: nan is not finite"),
    "unreachable state": (
        "ends_step = true",
        'ends_step = true\nnext = "land"',
        "no state leads to swing', land'; give the state before it a `next`, or delete it",
    ),
    "contact": (
        'contact = "right_foot"',
        'contact = "right_fot"',
        "state.swing.until.contact: unknown contact 'right_fot'; did you mean 'right_foot'?",
    ),
    "stance": (
        'stance = "right_foot"\n\n[[state]]',
        'stance = "right_toe"\n\n[[state]]',
        "state.swing.stance: unknown foot 'right_toe'; did you mean 'right_foot'? "
        "known: left_foot, right_foot",
    ),
    "stance of a perturbation": (
        'stance = "right_foot"\npose = { r_hip',
        'stance = "r_foot"\npose = { r_hip',
        "perturbation.hip.stance: unknown foot 'r_foot'; did you mean 'right_foot'?",
    ),
    "next": (
        "ends_step = true",
        'ends_step = true\nnext = "swign"',
        "state.land.next: unknown state 'swign'; did you mean 'swing'?",
    ),
    "time and contact": (
        "time = 0.25",
        'time = 0.25, contact = "left_foot"',
        "state.land.until: give either `time` or `contact`, and only one of them",
    ),
    "neither time nor contact": (
        "time = 0.25",
        "timeout = 0.25",
        "state.land.until: give either `time` or `contact`, and only one of them",
    ),
    "negative time": (
        "time = 0.25",
        "time = -0.25",
        "state[1].until.time: Expected `float` >= 0.0",
    ),
    "columns": ("[10, 40]", "[10, 40, 1]", "state.swing.pose: 3 values for 2 columns"),
    "state twice": (
        'name = "land"',
        'name = "swing"',
        "state.swing: this name stands twice; give each its own",
    ),
    "perturbation twice": ('name = "turn"', 'name = "hip"', "hip: this name stands twice"),
    "state that slides": (
        "[[state]]",
        '[slip]\nstates = ["lnad"]\nstyle = "slow"\nleast = 0.02\n\n[[state]]',
        "slip.states: unknown state 'lnad'; did you mean 'land'?",
    ),
    "style for slippery ground": (
        "[[state]]",
        '[slip]\nstates = ["land"]\nstyle = "slwo"\nleast = 0.02\n\n[[state]]',
        "slip.style: unknown style 'slwo'; did you mean 'slow'?",
    ),
    "state of a perturbation": (
        'states = ["land"]',
        'states = ["lnad"]',
        "perturbation.slow.states: unknown state 'lnad'; did you mean 'land'?",
    ),
}


@pytest.mark.parametrize(("old", "new", "message"), BAD.values(), ids=BAD.keys())
def test_bad_input_is_one_line_with_file_and_key(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    assert old in GAIT
    with pytest.raises(ConfigError) as error:
        gait(tmp_path, GAIT.replace(old, new, 1))
    text = str(error.value)
    assert text.startswith(f"{tmp_path / 'test.toml'}: ")
    assert message in text
    assert "\n" not in text


STATE = """[[state]]
name = "A"
until = { time = 0.1 }
ends_step = true"""

BALANCED = f"""
title = "Balanced"
{STATE}
[[perturbation]]
name = "hip"
pose = {{ r_hip = 2 }}
[balance]
regulation = ["up.forward"]
perturbations = ["hip"]
[speed]
default = 0.1
rows = [{{ speed = 0.0, scale = {{ hip = 0.0 }} }}, {{ speed = 0.2, scale = {{ hip = 1.0 }} }}]
[heading]
perturbation = "hip"
gain = 0.3
[torso_servo]
joint = "waist"
"""

MISMATCHED = {
    "no state": (STATE, "state = []", "state"),
    "regulation": ('"up.forward"', '"up.foward"', "up.foward"),
    "perturbation of the balance": ('["hip"]', '["hop"]', "hop"),
    "scale of the speed": ("scale = { hip = 1.0 }", "scale = { hop = 1.0 }", "hop"),
    "no speed": (
        "rows = [{ speed = 0.0, scale = { hip = 0.0 } }, { speed = 0.2, scale = { hip = 1.0 } }]",
        "rows = []",
        "speed",
    ),
    "speeds that fall": ("speed = 0.2", "speed = -0.2", "speed"),
    "turn": ('perturbation = "hip"', 'perturbation = "hop"', "hop"),
    "torso servo": ('joint = "waist"', 'joint = "waits"', "waits"),
}


@pytest.mark.parametrize(("old", "new", "key"), MISMATCHED.values(), ids=MISMATCHED.keys())
def test_tables_that_do_not_fit_the_gait_are_refused_when_it_is_loaded(
    tmp_path: Path, old: str, new: str, key: str
) -> None:
    assert old in BALANCED
    gait(tmp_path, BALANCED)
    with pytest.raises(ConfigError) as error:
        gait(tmp_path, BALANCED.replace(old, new, 1))
    assert str(error.value).startswith(f"{tmp_path / 'test.toml'}: ")
    assert key in str(error.value)
