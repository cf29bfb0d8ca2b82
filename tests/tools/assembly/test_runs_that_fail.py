from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.tools.conftest import Windup
from windup import Robot
from windup.control.motions.play import GraphPlayer
from windup.hal.command import JointCommand
from windup.hal.errors import DivergedError, UnsafeCommandError
from windup.hal.observation import Observation
from windup.tools.assembly.build import build_walk
from windup.tools.stopping.interrupts import RunInterruptedError


class Trouble:
    """Holds the stance, and does something else from `at` s on."""

    def __init__(self, robot: Robot, at: float = 0.1) -> None:
        self.joints, self.pose, self.at = robot.description.joints, robot.description.stance, at

    def reset(self, observation: Observation) -> None: ...

    def step(self, observation: Observation, dt: float) -> JointCommand:
        command = JointCommand.hold(self.joints, self.pose)
        return self.trouble(command) if observation.time >= self.at - 1e-9 else command

    def trouble(self, command: JointCommand) -> JointCommand:
        raise NotImplementedError


class NotANumber(Trouble):
    def trouble(self, command: JointCommand) -> JointCommand:
        block = command.block.copy()
        block[0, 3] = np.nan
        return JointCommand(block)


class Crash(Trouble):
    def trouble(self, command: JointCommand) -> JointCommand:
        raise ZeroDivisionError("a bug of the controller's own")


def stopped(robot: Robot) -> bool:
    return not robot.twin.powered


@pytest.mark.parametrize("name", ["op3", "human"])
def test_nan_in_mid_run_is_refused_and_the_stop_policy_runs(name: str) -> None:
    with Robot.open(name) as robot:
        with pytest.raises(UnsafeCommandError) as error:
            robot.run(NotANumber(robot), 1.0)
        joint = robot.description.joints.names[3]
        assert str(error.value) == (
            f"the controller commanded position nan for joint {joint!r}; give finite values"
        )
        assert error.value.exit_status == 1
        assert robot.loop.reason == str(error.value)
        assert robot.loop.sim_time == pytest.approx(0.1, abs=0.01)
        assert stopped(robot)
        assert np.isfinite(robot.twin.data.qpos).all()
        assert robot.twin.time == pytest.approx(robot.loop.sim_time), "limp at once"


def test_a_robot_whose_stop_is_a_crouch_goes_down_and_then_limp(my_op3: Path) -> None:
    toml = my_op3 / "robot.toml"
    toml.write_text(toml.read_text().replace('stop = "limp"', 'stop = "crouch"', 1))
    with Robot.open(str(my_op3)) as robot:
        assert robot.description.stop == "crouch"
        with pytest.raises(UnsafeCommandError):
            robot.run(NotANumber(robot), 1.0)
        assert robot.twin.time == pytest.approx(robot.loop.sim_time + 1.5, abs=0.02)
        crouch = robot.description.crouch
        assert crouch is not None
        assert np.abs(robot.twin.data.qpos[7:] - crouch).max() < 0.35
        assert stopped(robot)


def test_a_controller_that_crashes_stops_the_robot_too() -> None:
    with Robot.open("op3") as robot:
        with pytest.raises(Exception, match="a bug of the controller's own"):
            robot.run(Crash(robot), 1.0)
        assert stopped(robot)


def test_nan_in_mid_walk_is_status_1(shell: Windup, monkeypatch: pytest.MonkeyPatch) -> None:

    def build(*arguments: Any, **named: Any) -> Any:
        walker = build_walk(*arguments, **named)
        step = walker.step

        def broken(observation: Observation, dt: float) -> JointCommand:
            command = step(observation, dt)
            return command.with_position(np.full(20, np.nan)) if observation.time > 0.5 else command

        walker.step = broken  # type: ignore[method-assign]
        return walker

    monkeypatch.setattr("windup.tools.robot.motions.build_walk", build)
    ran = shell("walk", "op3", "--steps", 5, "--json", "-")
    assert ran.status == 1
    message = "the controller commanded position nan for joint 'head_pan'; give finite values"
    assert ran.err.strip() == f"windup: {message}"
    assert ran.json["error"] == {"kind": "UnsafeCommand", "message": message, "exit_status": 1}


def test_a_twin_that_diverges_is_status_1(
    shell: Windup, my_human: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(my_human)
    toml = my_human / "robot.toml"
    soft = "stiffness = 50.0,   damping =   5.0"
    assert soft in toml.read_text()
    toml.write_text(toml.read_text().replace(soft, "stiffness = 1e7, damping = 0.0"))
    ran = shell("walk", my_human, "--open-loop", "--json", "-")
    assert ran.status == 1
    assert ran.json["error"]["kind"] == "Diverged"
    message = ran.json["error"]["message"]
    assert ran.err.strip() == f"windup: {message}"
    assert message.startswith("the twin diverged at 0.0")
    assert "first at joint '" in message


def test_a_stop_that_fails_in_a_diverged_twin_does_not_hide_why(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # MuJoCo writes its log there
    with Robot.open("op3") as robot:

        def watch(observation: Observation) -> None:
            if observation.time > 0.1:
                robot.twin.data.qvel[8] = np.nan

        robot.watch.append(watch)
        with pytest.raises(DivergedError, match=r"the twin diverged at 0\.10\d s"):
            robot.stand()
        assert robot.loop.reason.startswith("the twin diverged at 0.10")


# Ctrl-C


def test_an_interrupted_walk_reports_what_was_measured() -> None:
    with Robot.open("op3") as robot:

        def watch(observation: Observation) -> None:
            if observation.time > 1.2:
                raise KeyboardInterrupt

        robot.watch.append(watch)
        with pytest.raises(RunInterruptedError) as stopped_by:
            robot.walk(steps=40)
        result = stopped_by.value.report.result()
        assert result["reason"] == "interrupted"
        assert result["fell"] is False
        assert 2 <= result["steps"] < 40
        assert result["sim_time_s"] == pytest.approx(1.2, abs=0.01)
        assert result["distance_m"] > 0.0
        assert stopped(robot)


def test_a_walk_interrupted_before_its_first_step_has_all_its_keys() -> None:
    with Robot.open("op3") as robot:

        def watch(observation: Observation) -> None:
            raise KeyboardInterrupt

        robot.watch.append(watch)
        with pytest.raises(RunInterruptedError) as stopped_by:
            robot.walk(steps=40)
        result = stopped_by.value.report.result()
        assert (result["steps"], result["reason"]) == (0, "interrupted")
        for row in result["regulation"]:
            assert set(row) == {"name", "unit", "target", "mean", "sd"}
            assert row["mean"] is row["sd"] is None


def test_ctrl_c_in_a_walk_is_status_130_with_the_report(
    shell: Windup, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(*arguments: object) -> Any:
        def update(steps: int, speed: float) -> None:
            if steps == 3:
                raise KeyboardInterrupt

        return update

    monkeypatch.setattr("windup.tools.behaviours.walk._shown", interrupt)
    ran = shell("walk", "op3", "--steps", 40, "--json", "-")
    assert ran.status == 130
    assert (ran.json["steps"], ran.json["reason"]) == (3, "interrupted")
    assert "interrupted after 3 of 40 steps" in " ".join(ran.err.split())


def test_ctrl_c_in_a_played_graph_is_status_130_with_the_report(
    shell: Windup, monkeypatch: pytest.MonkeyPatch
) -> None:
    step = GraphPlayer.step

    def interrupted(self: GraphPlayer, observation: Observation, dt: float) -> JointCommand:
        if observation.time > 0.5:
            raise KeyboardInterrupt
        return step(self, observation, dt)

    monkeypatch.setattr(GraphPlayer, "step", interrupted)
    ran = shell("play", "op3", "wave", "--json", "-")
    assert ran.status == 130
    assert ran.json["reason"] == "interrupted"
    assert ran.json["sim_time_s"] == pytest.approx(0.5, abs=0.01)


# Using a robot


def test_opening_a_robot_moves_nothing() -> None:
    with Robot.open("op3") as robot:
        before = robot.twin.save().physics.tobytes()
        assert robot.twin.time == 0.0
    assert robot.twin.save().physics.tobytes() == before


def test_a_robot_stands_for_as_long_as_it_is_told() -> None:
    with Robot.open("op3") as robot:
        report = robot.stand(0.5)
        assert (report.reason, robot.fallen) == ("done", False)
        assert report.sim_time == pytest.approx(0.5, abs=1e-6)
        assert report.ticks == pytest.approx(125, abs=1)


def test_a_hard_push_ends_a_run_with_a_fall() -> None:
    with Robot.open("op3") as robot:
        robot.push(6.0, np.pi / 2, delay=0.2)
        report = robot.stand(5.0)
        assert report.reason == "fell"
        assert robot.fallen
        assert 0.2 < report.sim_time < 5.0
