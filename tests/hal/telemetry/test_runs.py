"""The runs in a ring: names of what their controllers publish, states, and marks."""

import sys
from pathlib import Path

import numpy as np
import pytest

from tests.hal.telemetry.small_ring import JOINTS, observation, ring, write
from windup.hal.command import JointCommand
from windup.hal.errors import TelemetryError
from windup.hal.publishing.controller_block import BlockNames, ControllerBlock
from windup.hal.publishing.run_state import RunState
from windup.hal.telemetry.layout import NAME_SLOTS
from windup.hal.telemetry.reader import TelemetryReader
from windup.hal.telemetry.writer import TelemetryWriter


class Balance:
    """Publishes two phases and an error."""

    published = BlockNames(("stand", "step"), ("calm", "pushed"), ("error",), ("rad",))

    def __init__(self, phase: int = 1) -> None:
        self.phase, self.asked = phase, 0

    def publish(self, block: ControllerBlock) -> None:
        self.asked += 1
        block.run_state = RunState.STEPPING
        block.phase, block.phase_time, block.reason = self.phase, 0.25, 1
        block.plans, block.late_plans, block.plan_lateness = 4, 1, 0.016
        block.values[0] = 0.1 * self.asked


@pytest.fixture
def writer(tmp_path: Path) -> TelemetryWriter:
    return ring(tmp_path)


def test_a_tick_has_what_the_controller_publishes_and_the_run_has_its_names(
    writer: TelemetryWriter,
) -> None:
    writer.begin(Balance())
    write(writer, range(1, 3))
    with TelemetryReader(writer.path) as reader:
        tick = reader.latest()
        assert tick is not None
        names = reader.names(int(tick["run"]))
        assert names is not None
        assert (names.run, names.controller, names.phases[tick["phase"]]) == (1, "Balance", "step")
        assert names.reasons[tick["reason"]] == "pushed"
        assert dict(zip(names.values, tick["values"], strict=False)) == {"error": 0.2}
        assert names.units == ("rad",)
        assert reader.header.states[tick["state"]] == "stepping"
    assert np.isnan(tick["values"][1:]).all()
    assert (tick["plans"], tick["late_plans"], tick["plan_lateness"]) == (4, 1, 0.016)
    assert tick["phase_time"] == 0.25


def test_a_controller_that_publishes_nothing_stands(writer: TelemetryWriter) -> None:
    writer.begin(Balance())
    write(writer, range(1, 2))
    writer.begin(object())
    write(writer, range(2, 3))
    with TelemetryReader(writer.path) as reader:
        tick = reader.latest()
        assert tick is not None
        assert reader.header.states[tick["state"]] == "standing"
        assert (tick["run"], tick["phase"], tick["reason"], tick["plans"]) == (2, -1, -1, 0)
        assert np.isnan(tick["values"]).all(), "those of the run before are gone"


def test_the_ring_keeps_the_names_of_the_last_runs(writer: TelemetryWriter) -> None:
    for _ in range(NAME_SLOTS + 2):
        writer.begin(Balance())
    with TelemetryReader(writer.path) as reader:
        known = [run for run in range(1, NAME_SLOTS + 3) if reader.names(run) is not None]
    assert known == list(range(3, NAME_SLOTS + 3))


def test_names_that_do_not_fit_are_refused(writer: TelemetryWriter) -> None:
    class Wordy(Balance):
        published = BlockNames(phases=tuple(f"phase {k} of a very long dance" for k in range(900)))

    with pytest.raises(TelemetryError, match=r"a controller publishes take \d+ bytes; at most"):
        writer.begin(Wordy())


def test_the_last_tick_of_a_failed_run_does_not_ask_the_controller(
    writer: TelemetryWriter,
) -> None:
    controller = Balance()
    writer.begin(controller)
    hold = JointCommand.hold(JOINTS, np.zeros(2))
    writer.record_last(observation(), hold, 1, 0)
    assert controller.asked == 0


def test_the_state_is_known_between_two_ticks(writer: TelemetryWriter) -> None:
    with TelemetryReader(writer.path) as reader:
        assert reader.state.words == "limp"
        writer.begin(Balance())
        write(writer, range(1, 2))
        assert reader.state.words == "stepping"
        writer.change_state(RunState.STOPPING)
        assert reader.state.words == "stopping"
        writer.end("fell", RunState.FALLEN)
        assert (reader.state.words, reader.ended) == ("fallen", "fell")
        writer.close()
        writer.change_state(RunState.HOLDING)
        assert (reader.state.words, reader.closed) == ("disconnected", True)


def test_the_begin_and_the_end_of_a_run_are_marked(writer: TelemetryWriter) -> None:
    writer.begin(Balance())
    write(writer, range(1, 3))
    writer.end("fell")
    with TelemetryReader(writer.path) as reader:
        marks = [(mark.sequence, mark.text) for mark in reader.marks()]
    assert marks == [(0, "run 1 begins: Balance"), (2, "run 1 ends: fell")]


def test_ticks_take_no_more_memory_than_there_is(writer: TelemetryWriter) -> None:
    writer.begin(Balance())
    write(writer, range(1, 50))
    before = sys.getallocatedblocks()
    write(writer, range(50, 1050))
    assert sys.getallocatedblocks() - before < 50


def test_marks_say_when_something_happened(writer: TelemetryWriter) -> None:
    write(writer, range(1, 3))
    writer.mark("pushed by 3 N s")
    writer.mark("é" * 500)
    write(writer, range(3, 4))
    with TelemetryReader(writer.path) as reader:
        first, second = reader.marks()
        assert (first.number, first.sequence, first.text) == (1, 2, "pushed by 3 N s")
        assert second.text.startswith("ééé") and len(second.text) < 200
        assert reader.marks(after=1) == [second]
        assert reader.since()["marks"].tolist() == [0, 0, 2]
    for number in range(100):
        writer.mark(f"event {number}")
    with TelemetryReader(writer.path) as reader:
        assert [mark.number for mark in reader.marks()] == list(range(39, 103))
