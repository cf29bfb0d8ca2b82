"""Reuse of step models, as section 6.1.1 of the thesis proposes as future work.

Near a limit cycle the model of a step hardly changes. A memory returns a Jacobian that was sampled
before, so that a step needs only the nominal rollout, and none for each perturbation.
"""

from dataclasses import dataclass, field
from typing import ClassVar, Literal, Protocol

import numpy as np

from windup.hal.joints import Array

Reuse = Literal["full", "frozen", "library"]


class Memory(Protocol):
    """Store of Jacobians."""

    @property
    def complete(self) -> bool:
        """True if no more models are sampled: each step uses a stored one, and one rollout."""
        ...

    def reset(self) -> None:
        """Discard what is only valid for the last walk."""
        ...

    def recall(self, side: int, start: Array) -> Array | None:
        """Return a Jacobian (r, r) for a step on `side` from `start` (f,), or None."""
        ...

    def store(self, side: int, start: Array, jacobian: Array) -> None:
        """Store a Jacobian that has just been sampled."""
        ...


@dataclass
class Frozen:
    """Keeps the last model of each side.

    Attributes:
        settle: Number of models of each side that are sampled before one is reused.
    """

    complete: ClassVar[bool] = False
    settle: int = 4
    _known: dict[int, Array] = field(default_factory=dict, init=False)
    _made: dict[int, int] = field(default_factory=dict, init=False)

    def reset(self) -> None:
        """Discard all models."""
        self._known.clear()
        self._made.clear()

    def recall(self, side: int, start: Array) -> Array | None:
        """Return the last Jacobian of this side, or None before `settle` were sampled."""
        return self._known.get(side) if self._made.get(side, 0) >= self.settle else None

    def store(self, side: int, start: Array, jacobian: Array) -> None:
        """Replace the Jacobian of this side."""
        self._known[side] = jacobian
        self._made[side] = self._made.get(side, 0) + 1


@dataclass
class Library:
    """Keeps models with the start features of their steps, and looks up the nearest one.

    Attributes:
        reach: Maximum distance between the start features for a model to be reused.
        size: Number of models kept for each side; the oldest is dropped first.
    """

    complete: ClassVar[bool] = False
    reach: float = 0.05
    size: int = 64
    _known: dict[int, list[tuple[Array, Array]]] = field(default_factory=dict, init=False)

    def reset(self) -> None:
        """Keep all models: they are also valid in the next walk."""

    def recall(self, side: int, start: Array) -> Array | None:
        """Return the Jacobian whose start is nearest to `start`, or None beyond `reach`."""
        entries = self._known.get(side, [])
        if not entries:
            return None
        away = [float(np.linalg.norm(known - start)) for known, _ in entries]
        nearest = int(np.argmin(away))
        return entries[nearest][1] if away[nearest] <= self.reach else None

    def store(self, side: int, start: Array, jacobian: Array) -> None:
        """Store a Jacobian with its start; it replaces those with almost the same start."""
        entries = self._known.setdefault(side, [])
        entries[:] = [e for e in entries if np.linalg.norm(e[0] - start) > 0.3 * self.reach]
        entries.append((start, jacobian))
        del entries[: -self.size]


def memory_of(reuse: Reuse) -> Memory | None:
    """Return a new memory; None for "full", where every step's model is sampled."""
    return {"full": None, "frozen": Frozen(), "library": Library()}[reuse]
