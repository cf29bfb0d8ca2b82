import pytest

from windup.hal.guard.finding import FINDING_TEXTS, Finding
from windup.hal.guard.levels import HealthKind
from windup.tools.terminal.run_notes import RunNotes
from windup.tools.terminal.slowness import Slowness

WELL = Slowness(125.0)


def warm(joint: str, degrees: float) -> Finding:
    return Finding(
        FINDING_TEXTS[HealthKind.TEMPERATURE], degrees, 65.0, 1.0, joints=[joint], count=1
    )


def low(volts: float) -> Finding:
    return Finding(
        FINDING_TEXTS[HealthKind.SUPPLY_LOW], volts, 11.0, 1.0, joints=["a", "b"], count=2
    )


def test_a_command_begins_without_warnings() -> None:
    notes = RunNotes()
    assert (notes.ran, notes.summary(), notes.records()) == (False, "", [])
    notes.add([warm("l_knee", 66.0)], WELL)
    assert notes.ran
    notes.begin()
    assert (notes.ran, notes.summary(), notes.records()) == (False, "", [])


def test_the_same_cause_in_several_runs_is_one_warning() -> None:
    notes = RunNotes()
    for volts, degrees in ((10.8, 67.0), (10.5, 66.0)):
        notes.add([low(volts), warm("l_knee", degrees)], WELL)
    notes.add([warm("r_knee", 68.0)], WELL)
    assert notes.summary() == (
        "a and b were on 10.5 V (warning below 11.0); "
        "l_knee and r_knee were at 68 degrees C (warning at 65)"
    )
    assert [(row["kind"], row["value"], row["count"]) for row in notes.records()] == [
        ("supply low", 10.5, 4),
        ("temperature", 68.0, 3),
    ]


def test_what_ended_the_run_is_not_said_twice() -> None:
    notes = RunNotes()
    notes.add([low(10.5), warm("l_knee", 66.0)], WELL)
    assert notes.summary("temperature") == "a and b were on 10.5 V (warning below 11.0)"
    assert len(notes.records()) == 2, "programs get all"


def test_a_slow_computer_is_part_of_the_line() -> None:
    notes = RunNotes()
    notes.add([warm("l_knee", 66.0)], Slowness(125.0, ticks=50, missed=10))
    notes.add([], Slowness(125.0, ticks=40))
    said = "l_knee was at 66 degrees C (warning at 65); 10 % of the ticks came late"
    assert notes.summary().startswith(said)
    assert notes.records()[-1]["kind"] == "late ticks"


def test_runs_in_other_processes_are_counted() -> None:
    notes = RunNotes()
    record = warm("l_knee", 66.0).record()
    for seed, warnings in enumerate(([], [record], [record])):
        notes.add_row({"seed": seed, "warnings": warnings})
    assert notes.summary() == "2 of 3 runs had temperature"
    assert [row["seed"] for row in notes.records()] == [1, 2]


@pytest.mark.parametrize("times", [1, 3])
def test_what_a_session_notes_stays_its_own(times: int) -> None:
    notes, finding = RunNotes(), warm("l_knee", 66.0)
    for _ in range(times):
        notes.add([finding], WELL)
    assert (finding.count, finding.joints) == (1, ["l_knee"])


class Clamping:
    """A driver of servos that has clamped."""

    alert_kinds: tuple[str, ...] = ()

    def __init__(self, **clamps: int) -> None:
        self.clamps, self.alerts = clamps, dict[str, tuple[str, ...]]()

    def bus_errors(self) -> dict[str, int]:
        return {}


def test_what_drivers_have_clamped_adds_up_over_runs_and_processes() -> None:
    notes = RunNotes()
    notes.add([], WELL)
    notes.add([], WELL, Clamping(goal=3, gain=0))
    notes.add_row({"seed": 1, "warnings": [], "driver_clamps": {"goal": 2, "unarmed": 1}})
    notes.add_row({"seed": 2, "warnings": []})
    assert notes.driver_clamps == {"goal": 5, "gain": 0, "unarmed": 1}
    notes.begin()
    assert notes.driver_clamps == {}
