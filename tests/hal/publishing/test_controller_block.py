from math import isnan
from unittest.mock import MagicMock

import numpy as np
import pytest

from windup.hal.errors import UsageError
from windup.hal.publishing.controller_block import (
    MOST_VALUES,
    NOTHING,
    BlockNames,
    BlockPart,
    ControllerBlock,
    innermost,
    publisher_of,
)
from windup.hal.publishing.run_state import RunState


class Walk:
    published = BlockNames(("left", "right"), ("planned",), ("speed", "side"), ("m/s", "m/s"))

    def publish(self, block: ControllerBlock) -> None:
        block.run_state, block.phase, block.reason = RunState.WALKING, 1, 0
        block.plans, block.late_plans, block.plan_lateness = 7, 2, 0.5
        block.values[:] = 0.3, 0.1


class Step:
    published = BlockNames(("stand", "swing"), ("calm", "pushed"), ("x",), ("m",))
    phase = 1

    def publish(self, block: ControllerBlock) -> None:
        block.run_state, block.phase, block.reason = RunState.STEPPING, self.phase, 1
        block.values[0] = 0.7


def test_a_controller_publishes_if_it_has_names_and_a_method() -> None:
    walk = Walk()
    assert publisher_of(walk) is walk
    assert publisher_of(object()) is None


def test_values_without_units_are_ratios() -> None:
    assert BlockNames(values=("a", "b")).units == ("1", "1")


@pytest.mark.parametrize(
    ("values", "units", "said"),
    [
        (MOST_VALUES + 1, 0, f"publishes {MOST_VALUES + 1} values; at most {MOST_VALUES} fit"),
        (2, 1, "publishes 2 values with 1 units; give as many"),
    ],
)
def test_values_that_do_not_fit_are_refused(values: int, units: int, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        BlockNames(values=("v",) * values, units=("m",) * units)


def test_parts_share_a_block_and_the_last_one_published_gives_the_codes() -> None:
    first = BlockPart.of(Walk())
    second = BlockPart.of(step := Step(), before=first.names)
    names = second.all_names
    assert names.values == ("speed", "side", "x")
    block = ControllerBlock.of(names)
    first.publish(block)
    assert (names.phases[block.phase], names.reasons[block.reason]) == ("right", "planned")
    second.publish(block)
    assert (names.phases[block.phase], names.reasons[block.reason]) == ("swing", "pushed")
    assert block.run_state is RunState.STEPPING
    assert block.values.tolist() == [0.3, 0.1, 0.7]
    assert (block.plans, block.late_plans, block.plan_lateness) == (7, 2, 0.5)
    step.phase = -1
    second.publish(block)
    assert block.phase == -1


def test_a_part_follows_its_controller_into_another_block() -> None:
    part = BlockPart.of(Walk())
    blocks = [ControllerBlock.of(part.names) for _ in range(2)]
    for block in blocks:
        part.publish(block)
        assert block.values.tolist() == [0.3, 0.1]


def test_a_part_that_publishes_nothing_stands() -> None:
    part = BlockPart.of(object())
    block = ControllerBlock(np.zeros(0), RunState.FALLING, 3, 1.0, 2)
    part.publish(block)
    assert part.names == NOTHING
    assert (block.run_state, block.phase, block.reason) == (RunState.STANDING, -1, -1)
    assert isnan(block.phase_time)


class Wrapper:
    def __init__(self, controller: object) -> None:
        self.controller = controller

    def step(self) -> None: ...


def test_the_innermost_controller_is_one_that_can_step() -> None:
    inner = Wrapper("a gain, not a controller")
    assert innermost(Wrapper(Wrapper(inner))) is inner
    assert innermost(inner) is inner
    assert isinstance(innermost(MagicMock()), MagicMock), "it ends"


def test_states_have_words() -> None:
    assert [state.words for state in RunState][:3] == ["disconnected", "limp", "holding"]
