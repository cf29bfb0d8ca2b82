"""The arrays of a run: recorded where asked for, saved, loaded, drawn."""

from pathlib import Path

import numpy as np
import pytest

from windup import JointCommand, Robot, load_run
from windup.hal.errors import UsageError
from windup.tools.reports.run_data import UNITS, RunData


@pytest.fixture(scope="module")
def data() -> RunData:
    with Robot.open("op3", record=True) as robot:
        ticks = robot.ticks(seconds=0.4)
        for observation in ticks:
            goal = robot.description.stance.copy()
            goal[robot.joints.index("head_pan")] = 10.0 * observation.time
            robot.write(JointCommand.of(robot.joints, position=goal))
        return ticks.report.data


def test_every_tick_has_a_row_and_every_array_a_unit(data: RunData) -> None:
    ticks, joints, contacts = 100, len(data.joints), len(data.contacts)
    shapes = {name: array.shape for name, array in data.arrays.items()}
    assert set(shapes) == set(UNITS) == set(data.units)
    assert {shape[0] for shape in shapes.values()} == {ticks}
    assert shapes["time"] == (ticks,) and shapes["contacts"] == (ticks, contacts)
    assert shapes["position_asked"] == shapes["position"] == (ticks, joints)
    assert data.arrays["time"][[0, -1]] == pytest.approx([0.0, 0.396])


def test_what_was_asked_for_and_what_the_joints_got_are_apart(data: RunData) -> None:
    pan = data.joints.index("head_pan")
    asked, applied = data.arrays["position_asked"][:, pan], data.arrays["position_applied"][:, pan]
    assert asked.max() == pytest.approx(3.96) and applied.max() < 3.2


def test_a_saved_run_is_loaded_as_it_was(data: RunData, tmp_path: Path) -> None:
    path = tmp_path / "run.npz"
    data.save(path)
    loaded = load_run(path)
    assert (loaded.robot, loaded.reason) == ("op3", "done")
    assert (loaded.joints, loaded.contacts) == (data.joints, data.contacts)
    assert loaded.units == data.units
    for name, array in data.arrays.items():
        np.testing.assert_array_equal(loaded.arrays[name], array)
    with np.load(path) as file:
        assert file["joint_names"].tolist() == list(data.joints)


def test_a_file_that_is_no_run_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"no\.npz cannot be read: No such file"):
        load_run(tmp_path / "no.npz")
    other = tmp_path / "other.npz"
    np.savez(other, time=np.zeros(3))
    with pytest.raises(UsageError, match=r"other\.npz is not the file of a run \(without cont"):
        load_run(other)
    other.write_text("text")
    with pytest.raises(UsageError, match="is not the file of a run"):
        load_run(other)


def test_a_run_is_drawn(data: RunData, tmp_path: Path) -> None:
    data.plot(tmp_path / "run.png")
    assert (tmp_path / "run.png").stat().st_size > 10_000
    with pytest.raises(UsageError, match=r"run\.txt: name the picture \.png, "):
        data.plot(tmp_path / "run.txt")


def test_a_run_that_was_not_recorded_says_how_to() -> None:
    with Robot.open("op3") as robot:
        report = robot.stand(0.1)
    assert report.recording is None
    with pytest.raises(UsageError, match=r"Robot\.open\(\.\.\., record=True\)"):
        _ = report.arrays


def test_a_walk_has_arrays_too(tmp_path: Path) -> None:
    with Robot.open("op3", record=True) as robot:
        report = robot.walk(steps=2)
    assert len(report.arrays["time"]) == report.loop.ticks
    report.save(tmp_path / "walk.npz")
    assert load_run(tmp_path / "walk.npz").reason == report.loop.reason
    assert not report.fallen


def test_a_graph_that_was_played_says_how_hard_the_servos_worked() -> None:
    with Robot.open("op3") as robot:
        report = robot.play("wave", 0.5)
    assert report is robot.loop
    assert 0.0 < report.load.peak < 1.0 and report.retries == 0 and not report.fallen
