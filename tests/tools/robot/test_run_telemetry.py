"""What a robot's runs publish: states, clamps, and what its controllers do."""

import itertools
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from windup.hal.command import JointCommand
from windup.hal.errors import ControllerError
from windup.hal.observation import Observation
from windup.hal.telemetry.header import Header, bits_of
from windup.hal.telemetry.reader import TelemetryReader, Ticks
from windup.hal.telemetry.runtime_folder import ring_path
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.robot.robot import Robot


@pytest.fixture(autouse=True)
def rings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))


@pytest.fixture
def robot() -> Iterator[Robot]:
    with Robot.open("op3") as robot:
        yield robot


def ring(robot: Robot) -> TelemetryReader:
    return TelemetryReader(ring_path(robot.description.name, robot.stack.port))


def states(header: Header, ticks: Ticks) -> list[str]:
    """Return the states of a run, each once, in order."""
    codes = ticks["state"].tolist()
    changes = [codes[0]] + [b for a, b in itertools.pairwise(codes) if a != b]
    return [header.states[code] for code in changes]


class Reaching:
    """Asks every joint for more than it has, then fails."""

    def __init__(self, ticks: int) -> None:
        self.left = ticks

    def reset(self, observation: Observation) -> None:
        self.command = JointCommand(np.array([observation.joints.position] * 5))

    def step(self, observation: Observation, dt: float) -> JointCommand:
        self.left -= 1
        if self.left < 0:
            raise RuntimeError("no more")
        block = self.command.block.copy()
        block[0, 3], block[1:3], block[3], block[4] = 9.0, 0.0, 20.0, 0.5
        return JointCommand(block)


def test_a_walk_publishes_its_graph_its_targets_and_its_scalings(robot: Robot) -> None:
    report = robot.walk(steps=3, options=WalkOptions(open_loop=True))
    gait, records = report.walker.gait, report.walker.records
    with ring(robot) as reader:
        ticks = reader.since()
        ticks = ticks[ticks["run"] == ticks["run"][-1]]
        names = reader.names(int(ticks["run"][-1]))
        assert states(reader.header, ticks) == ["walking"]
    assert names is not None and names.phases[: len(gait.graph)] == gait.graph.names
    assert len(set(ticks["phase"].tolist())) == len(gait.graph)
    values = dict(zip(names.values, ticks[-1]["values"], strict=False))
    units = dict(zip(names.values, names.units, strict=True))
    for k, variable in enumerate(report.walker.regulation):
        assert values[f"regulation.{variable.name}"] == records[-1].regulation[k]
        assert units[f"target.{variable.name}"] == variable.unit
    assert [values[f"scaling.{name}"] for name in gait.perturbations] == pytest.approx(
        report.walker._tracker.scale[0]
    )
    assert names.reasons[ticks[-1]["reason"]] == "open loop"
    assert ticks["plans"][-1] == report.walker.begun


def test_planned_scalings_appear_in_the_tick_in_which_they_are_applied(robot: Robot) -> None:
    report = robot.walk(steps=1)
    walker = report.walker
    with ring(robot) as reader:
        ticks, names = reader.since(), reader.names(reader.latest()["run"])  # type: ignore[index]
    assert names is not None
    rows = [names.values.index(f"plan.{name}") for name in walker.perturbations]
    last = ticks[-1]
    assert last["values"][rows].tolist() == walker._kept[walker._first].tolist()
    assert names.reasons[last["reason"]] == "planned"
    assert (last["late_plans"], last["plan_lateness"]) == (0, 0.0)


def test_a_fall_is_published_before_the_robot_lies(robot: Robot) -> None:
    robot.shove(1.5, delay=0.1)
    assert robot.stand(4.0).reason == "fell"
    with ring(robot) as reader:
        assert states(reader.header, reader.since()) == ["standing", "falling", "fallen"]
        assert (reader.state.words, reader.ended) == ("fallen", "fell")


def test_what_is_clamped_is_asked_and_applied_and_named(robot: Robot) -> None:
    with pytest.raises(ControllerError):
        robot.run(Reaching(5), seconds=1.0)
    with ring(robot) as reader:
        tick = reader.latest()
        assert tick is not None
        assert tick["asked"][0, 3] == 9.0
        assert tick["applied"][0, 3] == pytest.approx(robot.description.joints.upper[3], abs=2e-3)
        bits = [bits_of(bits, reader.header.clamp_bits) for bits in tick["clamped_by"]]
        assert bits == [["guard position"] if k == 3 else [] for k in range(len(bits))]
        assert reader.state.words == "faulted"
        assert reader.ended == "the controller failed: RuntimeError: no more"


def test_states_between_runs_are_those_of_the_torque() -> None:
    with Robot.open("op3", port="twin://op3") as robot:
        robot.stand(0.1)
        with ring(robot) as reader:
            assert reader.state.words == "holding"
            robot.stop(limp=True)
            assert reader.state.words == "limp"
            assert reader.header.versions["windup"]
    assert reader.header.port == "twin://op3"
    with ring(robot) as reader:
        assert (reader.state.words, reader.closed) == ("disconnected", True)
