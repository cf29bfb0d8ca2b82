"""Speed, side, turn and style as scalings and targets of the coming step."""

from dataclasses import replace
from math import pi, radians

import pytest

from windup.control.pose_graph.gait import Gait
from windup.control.pose_graph.gait_file import Heading, Side, Style, Turn
from windup.control.pose_graph.style import StyleInterval, Styling
from windup.control.steering.course import Course
from windup.control.steering.guide import WalkCommand
from windup.control.steering.side import SideControl
from windup.hal.errors import UnknownNameError, UsageError
from windup.robots import load_robot
from windup.tools.assembly.gaits import find_gait
from windup.tools.assembly.style_intervals import spell


@pytest.fixture(scope="module")
def gait() -> Gait:
    return find_gait(load_robot("op3"), "walk")


def with_file(gait: Gait, **changes: object) -> Gait:
    import msgspec

    return replace(gait, file=msgspec.structs.replace(gait.file, **changes))


def test_a_turn_moves_the_wanted_heading_on_by_its_rate() -> None:
    course = Course(Heading("turn", gain=0.5, limit=20.0), Turn(limit=50.0, feed=0.6))
    course.begin_step(WalkCommand(turn=radians(40.0)), heading=0.0, duration=0.25)
    assert course.direction == pytest.approx(radians(10.0))
    assert course.scale(0.0) == pytest.approx(0.6 * 10.0 + 0.5 * 10.0)
    assert course.scale(radians(10.0)) == pytest.approx(6.0)


def test_a_direction_is_reached_no_faster_than_the_turn_allows_and_then_held() -> None:
    course = Course(Heading("turn", gain=0.5), Turn(limit=50.0))
    order = WalkCommand(turn=radians(20.0), direction=-radians(7.0))
    for wanted in (-5.0, -7.0, -7.0):
        course.begin_step(order, heading=course.direction, duration=0.25)
        assert course.direction == pytest.approx(radians(wanted))


def test_the_short_way_round_is_taken() -> None:
    course = Course(Heading("turn", gain=0.5), Turn(limit=400.0), direction=pi - 0.1)
    course.begin_step(WalkCommand(turn=6.0, direction=-pi + 0.1), heading=pi - 0.1, duration=1.0)
    assert course.rate == pytest.approx(0.2)


def test_a_body_that_does_not_follow_is_not_left_behind() -> None:
    course = Course(Heading("turn", gain=0.5), Turn(limit=400.0))
    for _ in range(9):
        course.begin_step(WalkCommand(turn=1.0), heading=0.0, duration=0.5)
    assert course.direction == pytest.approx(radians(30.0))


def test_walking_sideways_moves_the_targets_of_the_two_feet_apart(gait: Gait) -> None:
    law = Side(limit=0.1, ramp=0.02, targets={"xcom.lateral": -0.2}, spread={"spread": 50.0})
    side = SideControl(with_file(gait, side=law), -0.08)
    side.begin_step(-0.08)
    assert side.targets(swing_is_left=True) == {"xcom.lateral": pytest.approx(0.004)}
    assert side.targets(swing_is_left=False) == {"xcom.lateral": pytest.approx(-0.004)}
    assert side.scale()[gait.index("spread")] == pytest.approx(1.0)


def test_sideways_feedback_looks_at_whole_strides(gait: Gait) -> None:
    side = SideControl(with_file(gait, side=Side(limit=0.1, gain=0.5, correction=0.02)))
    side.measured(0.3)
    assert side.correction == 0.0
    side.measured(-0.32)
    assert side.correction == pytest.approx(0.005)


def test_a_side_speed_past_the_gait_is_refused(gait: Gait) -> None:
    with pytest.raises(UsageError, match=r"at most at 0\.1 m/s"):
        SideControl(gait, 0.3)
    with pytest.raises(UsageError, match="cannot walk sideways"):
        SideControl(with_file(gait, side=None), 0.1)


def test_styles_compose_and_ramp(gait: Gait) -> None:
    low = Style(
        name="low", scale={"crouch": 4.0, "lift": 1.0}, targets={"up.forward": 0.1}, steps=2
    )
    styling = Styling(with_file(gait, style=[low]), {"low": 1.0, "lift": -2.0})
    styling.begin_step(0.0)
    assert styling.scale()[gait.index("crouch")] == pytest.approx(2.0)
    styling.begin_step(0.3)
    assert styling.targets() == {"up.forward": pytest.approx(0.1)}
    styling.begin_step(0.6)
    assert styling.scale()[gait.index("lift")] == pytest.approx(-1.0)


def test_a_style_that_is_not_there_or_too_much_is_refused(gait: Gait) -> None:
    with pytest.raises(UnknownNameError, match="did you mean 'crouch'"):
        Styling(gait, {"crouh": 1.0})
    with pytest.raises(UsageError, match="outside its range"):
        Styling(gait, {"crouch": 40.0})


def test_a_spell_comes_in_and_goes_out_by_the_ramp_of_its_style(gait: Gait) -> None:
    low = Style(name="low", scale={"crouch": 4.0}, steps=2)
    styling = Styling(with_file(gait, style=[low]), spells=(StyleInterval("low", 1.0, 1.0, 3.0),))
    seen = []
    for time in range(10, 17):
        styling.begin_step(float(time))
        seen.append(styling.present.get("low", 0.0))
    assert seen == pytest.approx([0.0, 0.5, 1.0, 0.5, 0.0, 0.0, 0.0])


def test_a_spell_outside_the_range_of_its_style_is_refused(gait: Gait) -> None:
    with pytest.raises(UsageError, match="style crouch=40 is outside its range"):
        Styling(gait, spells=(StyleInterval("crouch", 40.0, 5.0),))


def test_spells_are_read_with_and_without_amount_and_times() -> None:
    assert spell("duck", "--style") == StyleInterval("duck", 1.0)
    assert spell("duck=-2@5", "--style") == StyleInterval("duck", -2.0, 5.0)
    assert spell("duck=1@5:12", "--style") == StyleInterval("duck", 1.0, 5.0, 12.0)


@pytest.mark.parametrize(
    ("text", "message"),
    {
        "duck=much": "--style duck=much: 'much' is no number",
        "duck=nan": "--style duck=nan: nan: give a finite number",
        "duck@5:4": "--style duck@5:4: begin at 0 s or later, and end after that",
        "duck@-1": "--style duck@-1: begin at 0 s or later, and end after that",
        "duck@soon": "--style duck@soon: 'soon' is no number",
    }.items(),
)
def test_a_spell_that_cannot_be_is_refused(text: str, message: str) -> None:
    with pytest.raises(UsageError) as error:
        spell(text, "--style")
    assert str(error.value) == message


def test_what_the_ground_calls_for_comes_on_top_of_the_style_that_was_asked_for(
    gait: Gait,
) -> None:
    styling = Styling(gait, {"lift": -2.0})
    for _ in range(20):
        styling.begin_step(0.0, {"lift": 0.5, "crouch": 3.0})
    assert styling.present == {"lift": pytest.approx(-1.5), "crouch": pytest.approx(3.0)}
