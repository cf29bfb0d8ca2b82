from dataclasses import dataclass
from math import inf, nan
from typing import Annotated, Literal

import numpy as np
import pytest

from windup.hal.errors import UsageError
from windup.hal.ranges import Range, check_numbers, numbers_checked, read_number

Share = Annotated[float, Range(0.0, 1.0, "m")]


@dataclass
class Wish:
    share: Share | None = None
    turn_rate: float = 0.0
    to: tuple[Share, Share] | None = None
    way: Share | Literal["random"] = "random"
    many: Annotated[int, Range(1, 9)] = 1
    on: bool = True


@pytest.mark.parametrize(
    ("range", "value", "problem"),
    [
        (Range(), 1e300, ""),
        (Range(), nan, "give a finite number"),
        (Range(0.0, 1.0, "s"), -inf, "give a finite number of s"),
        (Range(0.0, 1.0, "s"), 0.0, ""),
        (Range(0.0, 1.0, "s", above=True), 0.0, "give more than 0, up to 1 s"),
        (Range(0.0, 1.0, "s"), 1.5, "give 0 .. 1 s"),
        (Range(0, 2**32 - 1), 10**400, "give 0 .. 4294967295"),
        (Range(0.0, 1.0), np.float32(nan), "give a finite number"),
    ],
)
def test_what_would_be_right_is_said(range: Range, value: float, problem: str) -> None:
    assert range.problem(value) == problem


@pytest.mark.parametrize(
    ("wish", "said"),
    [
        (Wish(), None),
        (Wish(share=1.0, to=(0.0, 1.0), way=0.5, many=9), None),
        (Wish(share=2.0), "--share 2: give 0 .. 1 m"),
        (Wish(turn_rate=nan), "--turn-rate nan: give a finite number"),
        (Wish(to=(0.5, inf)), "--to inf: give a finite number of m"),
        (Wish(way=-1.0), "--way -1: give 0 .. 1 m"),
        (Wish(many=10**12), "--many 1000000000000: give 1 .. 9"),
    ],
)
def test_every_number_of_a_dataclass_is_checked(wish: Wish, said: str | None) -> None:
    if said is None:
        check_numbers(wish, "--")
        return
    with pytest.raises(UsageError) as error:
        check_numbers(wish, "--")
    assert str(error.value) == said


def test_arguments_of_a_function_are_checked_before_it_runs() -> None:
    ran: list[float] = []

    @numbers_checked
    def stand(seconds: Share = 0.5, *, heading: float = 0.0) -> None:
        ran.append(seconds)

    stand()
    stand(1.0, heading=-3.0)
    for arguments, named in [((2.0,), {}), ((), {"heading": nan})]:
        with pytest.raises(UsageError, match=r"seconds 2: give 0 .. 1 m|heading nan: give a fin"):
            stand(*arguments, **named)
    assert ran == [0.5, 1.0]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("much", "--x: 'much' is no number"),
        ("nan", "--x: nan: give a finite number of m"),
        ("1e999", "--x: 1e999: give a finite number of m"),
        ("-1", "--x: -1: give 0 .. 1 m"),
        ("9" * 5000, f"--x: {'9' * 40}: give a finite number of m"),
    ],
)
def test_a_number_in_a_text_is_checked(text: str, said: str) -> None:
    with pytest.raises(UsageError) as error:
        read_number("--x", text, Range(0.0, 1.0, "m"))
    assert str(error.value) == said
