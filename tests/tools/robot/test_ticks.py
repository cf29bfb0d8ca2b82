"""A run whose controller is the body of a `for` loop, on the twin and on emulated servos."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from tests.tools.robot.worlds import WORLDS, head, on_servos, on_the_twin, turned
from windup import JointCommand, Robot
from windup.hal.errors import UnsafeCommandError, UsageError
from windup.tools.robot.run_end import LEFT


@pytest.fixture(params=WORLDS)
def robot(request: pytest.FixtureRequest) -> Iterator[Robot]:
    with WORLDS[request.param]() as robot:
        yield robot


@pytest.fixture
def duck() -> Iterator[Robot]:
    with on_servos("duck") as robot:
        yield robot


def test_ticks_keep_the_schedule_of_the_loop(robot: Robot) -> None:
    ticks = robot.ticks(seconds=0.4)
    times = np.array([observation.time for observation in ticks])
    np.testing.assert_allclose(np.diff(times), robot.period, atol=robot.period / 4)
    assert len(times) == ticks.report.ticks == round(0.4 / robot.period)
    assert ticks.report.reason == "done" and ticks.report is robot.loop


def test_what_the_body_writes_is_the_command_of_its_tick(robot: Robot) -> None:
    for observation in robot.ticks(seconds=1.0):
        command = turned(robot, 0.3)
        applied = robot.write(command)
        assert applied.position == pytest.approx(command.position, abs=0.002)
        assert robot.read() is observation
    assert head(robot) == pytest.approx(0.3, abs=0.05)


def test_a_tick_without_a_command_holds_the_last_one(robot: Robot) -> None:
    for _ in robot.ticks():
        robot.write(turned(robot, 0.3))
        break
    for _ in robot.ticks(seconds=1.0):
        pass
    assert head(robot) == pytest.approx(0.3, abs=0.05)


def test_before_the_first_command_the_pose_is_held() -> None:
    with on_the_twin() as robot:
        before = robot.read().joints.position
        for observation in robot.ticks(seconds=0.5):
            assert observation.joints.position == pytest.approx(before, abs=0.05)


def test_the_last_command_of_a_tick_counts_and_what_was_clamped_shows(robot: Robot) -> None:
    for _ in robot.ticks(seconds=1.0):
        robot.write(turned(robot, -0.3))
        applied = robot.write(turned(robot, 30.0))
        assert applied.position == pytest.approx(
            np.clip(turned(robot, 30.0).position, robot.joints.lower, robot.joints.upper), abs=0.002
        )
    assert head(robot) > 1.0 and robot.backend.clamps["position"] > 0


def test_each_tick_has_a_heartbeat_also_without_a_command(duck: Robot) -> None:
    beats = 0

    def beat() -> None:
        nonlocal beats
        beats += 1

    duck.stand(0.1)
    duck.backend.heartbeat = beat
    ticks = duck.ticks(seconds=0.4)
    assert len(list(ticks)) == beats == ticks.report.ticks


def test_a_loop_that_is_left_leaves_the_robot_held_and_another_run_goes_on(duck: Robot) -> None:
    ticks = duck.ticks()
    for observation in ticks:
        if observation.time > 3.0:
            break
    assert ticks.report.reason == LEFT and ticks.report.ticks > 3
    assert duck.armed and duck.stand(0.1).reason == "done"


def test_an_exception_in_the_body_stops_the_robot_at_the_end_of_the_with() -> None:
    with pytest.raises(ZeroDivisionError), on_servos("duck") as duck:
        for _ in duck.ticks():
            raise ZeroDivisionError
    assert duck.loop.reason == LEFT and not duck.armed


def test_a_robot_that_is_closed_in_the_body_rests_and_the_loop_ends(duck: Robot) -> None:
    passes = 0
    for _ in duck.ticks():
        passes += 1
        duck.close()
    assert passes == 1 and not duck.armed


def test_a_loop_whose_iterator_is_kept_ends_with_the_robot() -> None:
    with on_servos("duck") as duck:
        kept = iter(duck.ticks())
        next(kept)
    assert duck.loop.reason == "done", "it has crouched at last"
    assert not duck.armed and next(kept, None) is None


def test_what_the_guard_refuses_stops_the_robot_at_once(duck: Robot) -> None:
    wrong = np.full(len(duck.joints), np.nan)
    with pytest.raises(UnsafeCommandError, match="commanded position nan"):
        for _ in duck.ticks():
            duck.write(JointCommand.of(duck.joints, position=wrong))
    assert "position nan" in duck.loop.reason and not duck.armed


def test_a_refused_command_ends_the_loop_also_where_the_body_catches_it(duck: Robot) -> None:
    wrong, passes = np.full(len(duck.joints), np.nan), 0
    for _ in duck.ticks():
        passes += 1
        with pytest.raises(UnsafeCommandError):
            duck.write(JointCommand.of(duck.joints, position=wrong))
    assert passes == 1 and not duck.armed


def test_a_fall_ends_the_loop_and_is_softened_without_the_body() -> None:
    with on_the_twin() as robot:
        robot.push(6.0, delay=0.2)
        ticks, seen = robot.ticks(seconds=10.0), 0
        for _ in ticks:
            seen += 1
        assert ticks.report.fell and ticks.report.fallen
        assert 0 < seen < ticks.report.ticks, "the fall protection has some ticks alone"


def test_a_run_in_the_body_is_refused(robot: Robot) -> None:
    for _ in robot.ticks():
        with pytest.raises(UsageError, match="already running"):
            robot.stand(0.1)
        break


def test_torque_comes_on_with_the_first_motion_to_the_stance() -> None:
    with on_servos("op3") as robot:
        first = next(iter(robot.ticks(seconds=0.1)))
        assert first.joints.position == pytest.approx(robot.description.stance, abs=0.1)
        assert robot.start is not None and robot.start.motion.made


def test_joints_that_may_get_no_torque_are_only_read() -> None:
    with on_servos("duck") as duck:
        duck.stack = replace(duck.stack, may_arm=False)
        ticks = duck.ticks(seconds=0.2)
        for _ in ticks:
            with pytest.raises(UsageError, match=r"torque of duck is off: .*arm=True"):
                duck.write(turned(duck, 0.1))
        assert ticks.report.reason == "done" and ticks.report.ticks > 3 and not duck.armed


def test_a_list_of_numbers_is_no_command(robot: Robot) -> None:
    with pytest.raises(UsageError, match=r"not list: type JointCommand\.of\(robot\.joints"):
        robot.write([0.0] * 20)  # type: ignore[arg-type]


def test_two_loops_over_the_same_ticks_are_two_runs(robot: Robot) -> None:
    ticks = robot.ticks(seconds=0.1)
    first, one = len(list(ticks)), ticks.report
    assert len(list(ticks)) == first and ticks.report is not one
