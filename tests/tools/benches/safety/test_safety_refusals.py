"""What counts as a refusal: its exit status, its reason, and that no motor was driven."""

from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace

import pytest

from windup.tools.benches.safety import refusals
from windup.tools.benches.safety.refusals import REFUSALS, measure_refusals

HOT = next(refusal for refusal in REFUSALS if "75 C" in refusal.what)


def pretend(monkeypatch: pytest.MonkeyPatch, status: int, said: str, driven: int = 0) -> None:
    """Let the program of every trial end like this."""

    @contextmanager
    def trial(*_: object) -> Iterator[SimpleNamespace]:
        program = SimpleNamespace(join=lambda _: None, exitcode=status)
        events = [SimpleNamespace(value=driven)]
        journal = SimpleNamespace(listen=lambda _: None, since=lambda *_: events)
        yield SimpleNamespace(program=program, journal=journal, errors=lambda: said)

    monkeypatch.setattr(refusals, "trial", trial)
    monkeypatch.setattr(refusals, "REFUSALS", (HOT,))


@pytest.mark.parametrize(
    ("status", "said", "driven", "right"),
    [
        (3, "r_knee is at 75 degrees C (stop at 72): nothing has moved", 0, True),
        (2, "r_knee is at 75 degrees C (stop at 72): nothing has moved", 0, False),
        (3, "r_knee is at 75 degrees C (stop at 72): nothing has moved", 1, False),
        (3, "no answer from r_knee (id 13)", 0, False),
        (3, "", 0, False),
    ],
)
def test_a_refusal_has_its_status_its_reason_and_moves_nothing(
    monkeypatch: pytest.MonkeyPatch, status: int, said: str, driven: int, right: bool
) -> None:
    pretend(monkeypatch, status, said, driven)
    (found,) = measure_refusals(["op3"]).values()
    assert (found["right"], found["said"]) == (right, said)
