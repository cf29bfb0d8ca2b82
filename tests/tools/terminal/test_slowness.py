import pytest

from windup.tools.terminal.slowness import Slowness


@pytest.mark.parametrize(
    ("slow", "says"),
    [
        (
            {"ticks": 88, "missed": 12, "plans": 40, "late": 7},
            "12 % of the ticks and 7 of 40 plans came late: this computer is too slow for 125 Hz: "
            "try `--model library` or a lower --rate",
        ),
        (
            {"ticks": 100, "plans": 40, "late": 7, "library": True},
            "7 of 40 plans came late: this computer is too slow for 125 Hz: try a lower --rate",
        ),
        (
            {"ticks": 88, "missed": 12},
            "12 % of the ticks came late: this computer or its bus is too slow for 125 Hz: "
            "try a lower --rate",
        ),
        (
            {"ticks": 88, "missed": 12, "simulated": True},
            "12 % of the ticks came late: the bus is too slow for 125 Hz: try a lower --rate",
        ),
    ],
)
def test_what_came_late_is_said_with_its_cause_and_a_remedy(
    slow: dict[str, int], says: str
) -> None:
    assert str(Slowness(125.0, **slow)) == says  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "slow",
    [{}, {"ticks": 99, "missed": 1}, {"ticks": 100, "plans": 40, "late": 2}],
)
def test_little_is_nothing_to_say(slow: dict[str, int]) -> None:
    slowness = Slowness(125.0, **slow)  # type: ignore[arg-type]
    assert not slowness and slowness.records() == []


def test_programs_get_a_record_for_ticks_and_one_for_plans() -> None:
    records = Slowness(125.0, ticks=90, missed=10, plans=4, late=1).records()
    assert [(row["kind"], row["value"], row["count"]) for row in records] == [
        ("late ticks", 0.1, 10),
        ("late plans", 0.25, 1),
    ]
