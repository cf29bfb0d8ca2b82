"""Re-using step models: what section 6.1.1 of the thesis wished for.

Around a limit cycle the model of a step hardly changes. A memory hands out a Jacobian that was
sampled before, so that a step needs one nominal rollout instead of one more for each perturbation.
"""

from dataclasses import dataclass, field
from typing import ClassVar, Literal, Protocol

import numpy as np

from windup.hal.joints import Array

Reuse = Literal["full", "frozen", "library"]


class Memory(Protocol):
    """Keeps Jacobians."""

    @property
    def complete(self) -> bool:
        """True when no model is sampled any more: each step has one here, and one rollout."""
        ...

    def reset(self) -> None:
        """Forget everything that belongs to the last walk."""
        ...

    def recall(self, side: int, start: Array) -> Array | None:
        """Return a Jacobian (r, r) for a step on `side` from `start` (f,), or None."""
        ...

    def store(self, side: int, start: Array, jacobian: Array) -> None:
        """Keep a Jacobian that has just been sampled."""
        ...


@dataclass
class Frozen:
    """Remembers the last model of each side.

    Attributes:
        settle: Steps of each side that are sampled before any model is used again.
    """

    complete: ClassVar[bool] = False
    settle: int = 4
    _known: dict[int, Array] = field(default_factory=dict, init=False)
    _made: dict[int, int] = field(default_factory=dict, init=False)

    def reset(self) -> None:
        """Forget everything."""
        self._known.clear()
        self._made.clear()

    def recall(self, side: int, start: Array) -> Array | None:
        """Return the last Jacobian of this side."""
        return self._known.get(side) if self._made.get(side, 0) >= self.settle else None

    def store(self, side: int, start: Array, jacobian: Array) -> None:
        """Keep the Jacobian of this side."""
        self._known[side] = jacobian
        self._made[side] = self._made.get(side, 0) + 1


@dataclass
class Library:
    """Remembers models with the states they were made in, and looks up the nearest.

    Attributes:
        reach: A model from farther away does not count.
        size: Models kept for each side; the oldest goes first.
    """

    complete: ClassVar[bool] = False
    reach: float = 0.05
    size: int = 64
    _known: dict[int, list[tuple[Array, Array]]] = field(default_factory=dict, init=False)

    def reset(self) -> None:
        """Keep everything: what was learnt in one walk serves the next."""

    def recall(self, side: int, start: Array) -> Array | None:
        """Return the Jacobian that was made nearest to `start`."""
        entries = self._known.get(side, [])
        if not entries:
            return None
        away = [float(np.linalg.norm(known - start)) for known, _ in entries]
        nearest = int(np.argmin(away))
        return entries[nearest][1] if away[nearest] <= self.reach else None

    def store(self, side: int, start: Array, jacobian: Array) -> None:
        """Keep a Jacobian with its start, in place of one that it supersedes."""
        entries = self._known.setdefault(side, [])
        entries[:] = [e for e in entries if np.linalg.norm(e[0] - start) > 0.3 * self.reach]
        entries.append((start, jacobian))
        del entries[: -self.size]


def memory_of(reuse: Reuse) -> Memory | None:
    """Return a fresh memory; None remembers nothing and samples every step in full."""
    return {"full": None, "frozen": Frozen(), "library": Library()}[reuse]
