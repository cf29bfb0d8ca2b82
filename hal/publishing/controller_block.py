"""The block of a controller: codes and numbers about its internals, published every tick.

A controller that wants to be seen has an attribute `published`, the names, and a method `publish`,
which fills in a block that is used again every tick::

    class Balance:
        published = BlockNames(phases=("stand", "step"), values=("error",), units=("rad",))

        def publish(self, block):
            block.phase = 1 if self.stepping else 0
            block.values[0] = self.error

Publishing must not change what the controller does next.
"""

from dataclasses import dataclass, field
from math import nan
from typing import Final, Protocol, runtime_checkable

import numpy as np

from windup.hal.errors import UsageError
from windup.hal.joints import Array
from windup.hal.publishing.run_state import RunState

MOST_VALUES: Final = 64
"""Maximum number of values in a block."""
UNKNOWN: Final = -1
"""Code of a phase or reason that is not published."""


@dataclass(frozen=True)
class BlockNames:
    """Names of the codes and values of a block; they are constant during a run.

    Attributes:
        phases: Names of the phases, such as the states of a pose graph; a phase is an index.
        reasons: Names of the reasons for what the controller does; a reason is an index.
        values: Names of the values.
        units: Unit of each value, "1" for a ratio; by default all are "1".

    Raises:
        UsageError: There are more values than a block has room for, or units for other values.
    """

    phases: tuple[str, ...] = ()
    reasons: tuple[str, ...] = ()
    values: tuple[str, ...] = ()
    units: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        count = len(self.values)
        if count > MOST_VALUES:
            raise UsageError(f"a controller publishes {count} values; at most {MOST_VALUES} fit")
        if not self.units:
            object.__setattr__(self, "units", ("1",) * count)
        if len(self.units) != count:
            raise UsageError(
                f"a controller publishes {count} values with {len(self.units)} units; give as many"
            )

    def __add__(self, other: "BlockNames") -> "BlockNames":
        """Return the names of a block with two parts, those of `other` last; see `BlockPart`."""
        return BlockNames(
            self.phases + other.phases,
            self.reasons + other.reasons,
            self.values + other.values,
            self.units + other.units,
        )


DEEPEST: Final = 4
"""Maximum number of controllers around another one."""
NOTHING: Final = BlockNames()
"""Names of a controller that publishes nothing."""


@dataclass(slots=True)
class ControllerBlock:
    """What a controller publishes in one tick; an attribute keeps its value until it is changed.

    Attributes:
        run_state: State of the run.
        phase: Index of the present phase, or -1.
        phase_time: Time in that phase, s; NaN if unknown.
        reason: Index of the reason for what the controller does, or -1.
        plans: Number of plans requested in this run.
        late_plans: Number of those that came too late.
        plan_lateness: Time from the instant at which the last plan was due until it was applied, s;
            NaN before the first.
        values: (v,) the values.
    """

    values: Array
    run_state: RunState = RunState.STANDING
    phase: int = UNKNOWN
    phase_time: float = nan
    reason: int = UNKNOWN
    plans: int = 0
    late_plans: int = 0
    plan_lateness: float = nan

    @classmethod
    def of(cls, names: BlockNames) -> "ControllerBlock":
        """Return an empty block with room for the named values, which are NaN."""
        return cls(np.full(len(names.values), nan))


@runtime_checkable
class Publisher(Protocol):
    """A controller that publishes a block."""

    @property
    def published(self) -> BlockNames:
        """Names of its codes and values."""
        ...

    def publish(self, block: ControllerBlock) -> None:
        """Fill in `block` for the tick whose command was just computed."""
        ...


def publisher_of(controller: object) -> Publisher | None:
    """Return a controller if it publishes a block, else None."""
    return controller if isinstance(controller, Publisher) else None


def innermost(controller: object) -> object:
    """Return the controller inside those that have one in their attribute `controller`."""
    for _ in range(DEEPEST):
        inner = getattr(controller, "controller", None)
        if not callable(getattr(inner, "step", None)):
            break
        controller = inner
    return controller


@dataclass
class BlockPart:
    """One controller's part of the block of a controller that is made of several.

    Attributes:
        publisher: The controller, or None if it does not publish.
        before: Names of the parts before it.
    """

    publisher: Publisher | None
    before: BlockNames = NOTHING
    names: BlockNames = field(init=False)

    def __post_init__(self) -> None:
        self.names = NOTHING if self.publisher is None else self.publisher.published
        self._whole: ControllerBlock | None = None

    @classmethod
    def of(cls, controller: object, before: BlockNames = NOTHING) -> "BlockPart":
        """Return the part of a controller, whether it publishes or not."""
        return cls(publisher_of(controller), before)

    @property
    def all_names(self) -> BlockNames:
        """Names of the parts up to and including this one."""
        return self.before + self.names

    def publish(self, block: ControllerBlock) -> None:
        """Fill in this part's values, and its codes as those of the whole block."""
        if self.publisher is None:
            block.run_state, block.phase_time = RunState.STANDING, nan
            block.phase = block.reason = UNKNOWN
            return
        if block is not self._whole:
            self._whole, start = block, len(self.before.values)
            self._own = ControllerBlock(block.values[start : start + len(self.names.values)])
        own, before = self._own, self.before
        self.publisher.publish(own)
        block.run_state, block.phase_time = own.run_state, own.phase_time
        block.phase = own.phase + len(before.phases) if own.phase >= 0 else UNKNOWN
        block.reason = own.reason + len(before.reasons) if own.reason >= 0 else UNKNOWN
        if own.plans:
            block.plans, block.late_plans = own.plans, own.late_plans
            block.plan_lateness = own.plan_lateness
