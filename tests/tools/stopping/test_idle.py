import threading
from dataclasses import dataclass, field

import pytest

from tests.small_world import JOINTS, FakeBackend
from windup.hal.errors import StaleStateError, UsageError, WindupError
from windup.hal.guard import GuardedBackend, SafetyLimits
from windup.hal.observation import Observation
from windup.tools.stopping.idle import IdleKeeper
from windup.tools.stopping.interrupts import check_not_interrupted, forget_interruption


@dataclass
class Stopped:
    """What the keeper says when it gives up."""

    error: WindupError | None = None
    said: threading.Event = field(default_factory=threading.Event)

    def __call__(self, error: WindupError | None) -> None:
        self.error = error
        self.said.set()


class Silent(FakeBackend):
    """A robot that does not answer any more."""

    def collect(self) -> Observation:
        raise StaleStateError("joint 'l_knee' has not answered for 0.30 s")


def guarded(backend: FakeBackend) -> GuardedBackend:
    return GuardedBackend(backend, SafetyLimits.of(JOINTS))


def test_it_reads_and_beats_until_somebody_commands_the_robot() -> None:
    beats, stopped = threading.Semaphore(0), Stopped()
    keeper = IdleKeeper(guarded(FakeBackend()), 60.0, beats.release, stopped)
    for _ in range(3):
        beats.acquire()
    keeper.end()
    assert not stopped.said.is_set()


def test_a_robot_that_nobody_commands_for_too_long_goes_limp_with_advice(
    caplog: pytest.LogCaptureFixture,
) -> None:
    stopped, backend = Stopped(), guarded(FakeBackend())
    keeper = IdleKeeper(backend, -1.0, lambda: None, stopped)
    assert stopped.said.wait(10.0) and stopped.error is None
    keeper.end()
    assert "call robot.stand(seconds)" in caplog.text


def test_a_robot_that_is_unwell_is_stopped_and_the_cause_is_kept() -> None:
    stopped = Stopped()
    keeper = IdleKeeper(guarded(Silent()), 60.0, lambda: None, stopped)
    assert stopped.said.wait(10.0)
    assert isinstance(stopped.error, StaleStateError)
    keeper.end()


def test_a_button_ends_the_hold_at_once_and_nothing_arms_by_itself(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    stopped = Stopped()
    monkeypatch.setattr(
        "windup.tools.stopping.idle.pressed_button", lambda backend: "the mode button"
    )
    keeper = IdleKeeper(guarded(FakeBackend()), 60.0, lambda: None, stopped)
    assert stopped.said.wait(10.0) and stopped.error is None
    keeper.end()
    assert "stopped by the mode button" in caplog.text
    with pytest.raises(UsageError, match="the mode button has stopped this program"):
        check_not_interrupted()
    forget_interruption()
