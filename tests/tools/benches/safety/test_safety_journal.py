import multiprocessing
import time
from multiprocessing.connection import Connection

import pytest

from windup.sim_twin.wire.serve.journal import Event
from windup.tools.benches.safety.emulated import Journal
from windup.tools.benches.safety.fault_timer import FaultTimer

Pipe = tuple[Connection, Connection]


@pytest.fixture
def pipe() -> Pipe:
    return multiprocessing.Pipe(duplex=False)


def test_the_journal_knows_how_many_motors_are_driven(pipe: Pipe) -> None:
    journal = Journal(pipe[0])
    pipe[1].send(Event(1.0, "driven", 14))
    assert journal.wait_until_still(1.0, still=False)
    for moment, driven in ((2.0, 3), (2.5, 0)):
        pipe[1].send(Event(moment, "driven", driven))
    assert journal.wait_until_still(1.0)
    assert [event.time for event in journal.since(2.0, "driven")] == [2.0, 2.5]


def test_motors_that_stay_driven_are_not_taken_for_stopped(pipe: Pipe) -> None:
    journal = Journal(pipe[0])
    pipe[1].send(Event(1.0, "driven", 14))
    assert journal.wait_until_still(1.0, still=False)
    assert not journal.wait_until_still(0.01)


def test_an_emulator_that_is_gone_says_nothing_more(pipe: Pipe) -> None:
    journal = Journal(pipe[0])
    pipe[1].send(Event(1.0, "driven", 14))
    pipe[1].close()
    journal.listen(0.1)
    assert journal.driven == 14


def test_a_fault_is_due_after_the_activity_has_begun_and_is_told_once(pipe: Pipe) -> None:
    begin = FaultTimer(pipe[1], 0.0)
    assert not begin.due()
    began = time.monotonic()
    begin.now("walking")
    begin.now("walking")
    assert begin.due() and begin.due()
    assert pipe[0].recv() == ("doing", "walking")
    kind, when = pipe[0].recv()
    assert kind == "fault" and when >= began
    assert not pipe[0].poll(0.0)
