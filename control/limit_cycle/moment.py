"""Where a walk is within its step."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Moment:
    """Position in the pose graph during a step.

    Attributes:
        state: Index of the graph's state.
        elapsed: Time since the state was entered, s.
        stance: Index of the stance foot.
    """

    state: int
    elapsed: float
    stance: int
