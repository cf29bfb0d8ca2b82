"""The discrete step model: from samples of one step to scalings that reach its targets.

Laszlo 1996, sections 3.2 and 3.7. A step maps scalings K to regulation variables, Q = h(K). The
model is linear, dQ = J K (Eq. 3.9), J is found by finite differences over rollouts, and its inverse
gives the scalings that reach a target (Eq. 3.11; its sign of dQ is a misprint: the desired change
is target minus nominal).

There are four sampling methods. "sp" takes each dimension alone (a diagonal J, superposition);
"fl" and "lf" solve one dimension after the other, with the scalings found before (section 3.7.2);
"full" samples the whole J, one-sided unless `centred`, and solves damped least squares.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from windup.control.limit_cycle.step_memory import Memory
from windup.control.pose_graph.gait_file import Sampling
from windup.hal.joints import Array, Mask

# Plays m steps with scalings (m, r); returns regulation variables (m, r) and which steps fell.
Sample = Callable[[Array], tuple[Array, Mask]]

# Start of a part of a graph: its first state, and the features of the robot there.
Place = tuple[int, Array]

SINGULAR = 1e-6
COUNTERS = ("retried", "dropped", "kept_last", "clipped", "sampled", "reused", "refined")


@dataclass
class StepModel:
    """Finds scalings for r regulation variables with r perturbations.

    Attributes:
        sampling: Sampling method of J.
        samples: (r,) distance of the samples from the origin, in units of the scalings.
        limits: (r,) maximum magnitude of each scaling.
        weights: (r,) weight of each variable, the reciprocal of a significant error.
        centred: Sample on both sides of the origin, not on it ("full": two-sided differences).
        from_last: Sample around `keep` times the same side's last K instead of around zero.
        keep: See `from_last`.
        regularisation: Damping of the least squares.
        rounds: Maximum number of Newton iterations that improve the scalings ("full").
        miss: Weighted error of the nominal rollout above which they are improved.
        memory: Memory of models for reuse ("full"), or None.
        drift: Weighted error above which a stored model is not reused but sampled again.
        counters: Numbers of retried, dropped, kept, .. results, by the names in `COUNTERS`.
    """

    sampling: Sampling
    samples: Array
    limits: Array
    weights: Array
    centred: bool = True
    from_last: bool = False
    keep: float = 0.7
    regularisation: float = 1e-3
    memory: Memory | None = None
    drift: float = 0.5
    rounds: int = 0
    miss: float = 0.3
    counters: dict[str, int] = field(default_factory=lambda: dict.fromkeys(COUNTERS, 0))
    _far: float = field(default=0.0, init=False)
    _last: dict[int, Array] = field(default_factory=dict, init=False)
    _jacobian: dict[int, Array] = field(default_factory=dict, init=False)

    def reset(self) -> None:
        """Discard the results of the last walk."""
        self._last.clear()
        self._jacobian.clear()
        if self.memory is not None:
            self.memory.reset()

    def control(
        self,
        sample: Sample,
        target: Array,
        side: int,
        start: Array | None = None,
        at: int | None = None,
    ) -> Array:
        """Return the scalings K (r,) for which the model predicts `target` (r,).

        Args:
            sample: Plays steps.
            target: Targets of the regulation variables.
            side: Side, or part of the graph, of the step; the last K is kept for each.
            start: Features (f,) of the start of the sampled part, for look-up in a memory.
            at: Part of the graph that begins at `start`, if not `side`: the rest of a step has its
                own models.
        """
        last = self._last.get(side, np.zeros(len(self.samples)))
        origin = self.keep * last if self.from_last else np.zeros_like(last)
        self._far = 0.0
        if self.sampling == "full":
            place = side if at is None else at, np.zeros(0) if start is None else start
            again = self._reused(sample, target, side, origin, place)
            wanted = self._full(sample, target, side, origin, place) if again is None else again
        else:
            wanted = self._by_dimension(sample, target, origin, last)
        scalings = np.clip(wanted, -self.limits, self.limits)
        self.counters["clipped"] += int((scalings != wanted).any())
        if self._far > self.miss and self.rounds:
            scalings = self._refined(sample, target, scalings, last)
        self._last[side] = scalings
        return scalings

    # One dimension at a time

    def _by_dimension(self, sample: Sample, target: Array, origin: Array, last: Array) -> Array:
        r = len(origin)
        order = [list(range(r))] if self.sampling == "sp" else [[j] for j in range(r)]
        if self.sampling == "lf":
            order.reverse()
        found = origin.copy()
        for group in order:
            found[group] = self._lines(sample, target, found, group, last)
        return found

    def _lines(
        self, sample: Sample, target: Array, base: Array, group: list[int], last: Array
    ) -> Array:
        """Return the scalings of the dimensions in `group`, each from a line by two samples."""
        low = [-self.samples[j] if self.centred else 0.0 for j in group]
        high = [self.samples[j] for j in group]
        tried = np.repeat(base[None], 2 * len(group), axis=0)
        for i, j in enumerate(group):
            tried[2 * i, j] += low[i]
            tried[2 * i + 1, j] += high[i]
        values, fell = sample(tried)
        found = []
        for i, j in enumerate(group):
            rows = slice(2 * i, 2 * i + 2)
            k, q = tried[rows, j], values[rows, j]
            if fell[rows].any():
                k, q, usable = self._retry(sample, base, j, k, q, fell[rows])
                if not usable:
                    found.append(last[j])
                    continue
            found.append(self._line(k, q, target[j], last[j]))
        return np.array(found)

    def _retry(
        self, sample: Sample, base: Array, j: int, k: Array, q: Array, fell: Mask
    ) -> tuple[Array, Array, bool]:
        """Replace a sample that fell by another one; return both, and whether they are usable.

        Centred samples are retried at half the distance on the side that did not fall; a one-sided
        sample on the other side of the origin.
        """
        if fell.all() or (not self.centred and fell[0]):
            self.counters["dropped"] += 1
            return k, q, False
        self.counters["retried"] += 1
        tried = base[None].copy()
        side = -self.samples[j] if not self.centred else 0.5 * (k[~fell][0] - base[j])
        tried[0, j] += side
        value, again = sample(tried)
        k, q = k.copy(), q.copy()
        k[fell], q[fell] = tried[0, j], value[0, j]
        return k, q, not again[0]

    def _line(self, k: Array, q: Array, target: float, last: float) -> float:
        slope = (q[1] - q[0]) / (k[1] - k[0])
        if abs(slope) < SINGULAR:
            self.counters["kept_last"] += 1
            return float(last)
        return float(k[0] + (target - q[0]) / slope)

    # The whole Jacobian

    def _reused(
        self, sample: Sample, target: Array, side: int, origin: Array, place: Place
    ) -> Array | None:
        """Return K from a stored model and one rollout; None if there is no valid model.

        A stored model is not valid if it predicts an error above `drift` for the last K.
        """
        if self.memory is None or (jacobian := self.memory.recall(*place)) is None:
            return None
        if side not in self._last and not self.memory.complete:
            return None
        values, fell = sample(origin[None])
        if self.memory.complete:
            self.counters["reused"] += 1
            return origin if fell[0] else origin + self._solve(jacobian, target - values[0])
        miss = target - values[0] - jacobian @ (self._last[side] - origin)
        if fell[0] or float(np.linalg.norm(self.weights * miss)) > self.drift:
            return None
        self.counters["reused"] += 1
        return origin + self._solve(jacobian, target - values[0])

    def _full(self, sample: Sample, target: Array, side: int, origin: Array, place: Place) -> Array:
        r = len(origin)
        self.counters["sampled"] += 1
        steps = np.diag(self.samples)
        tried = origin + np.concatenate([np.zeros((1, r)), steps, -steps[: r * self.centred]])
        values, fell = sample(tried)
        if fell[0] and origin.any():
            self.counters["retried"] += 1
            origin = np.zeros(r)
            tried = tried - tried[0]
            values, fell = sample(tried)
        if fell[0]:
            self.counters["kept_last"] += 1
            return self._last.get(side, origin)
        self._far = float(np.linalg.norm(self.weights * (target - values[0])))
        jacobian = self._differences(sample, origin, tried, values, fell, side)
        if np.abs(jacobian * self.samples).max() < SINGULAR:
            self.counters["kept_last"] += 1
            return self._last.get(side, origin)
        self._jacobian[side] = jacobian
        if self.memory is not None:
            self.memory.store(*place, jacobian)
        return origin + self._solve(jacobian, target - values[0])

    def _refined(self, sample: Sample, target: Array, found: Array, last: Array) -> Array:
        """Return the best of `found`, the `last` scalings, and Newton iterations from these."""

        def judged(tried: Array) -> tuple[Array, Array, float]:
            values, fell = sample(tried)
            misses = np.linalg.norm(self.weights * (target - values), axis=1)
            i = int(np.where(fell, np.inf, misses).argmin())
            return tried[i], values[i], float("inf") if fell[i] else float(misses[i])

        best, value, miss = judged(np.stack([found, last]))
        for _ in range(self.rounds):
            if miss < self.miss or miss == float("inf"):
                break
            self.counters["refined"] += 1
            near, lost = sample(best + np.diag(self.samples))
            jacobian = (near - value).T / self.samples
            jacobian[:, lost] = 0.0
            change = self._solve(jacobian, target - value)
            tried = np.clip(best + np.outer([1.0, 0.4], change), -self.limits, self.limits)
            new, there, left = judged(tried)
            if left > 0.95 * miss:
                break
            best, value, miss = new, there, left
        return best

    def _differences(
        self, sample: Sample, origin: Array, tried: Array, values: Array, fell: Mask, side: int
    ) -> Array:
        """Return J (r, r); columns whose samples fell are taken from the last good model."""
        r = len(origin)
        good = self._jacobian.get(side)
        jacobian = np.zeros((r, r))
        lost = []
        for j in range(r):
            rows = [1 + j, 1 + r + j] if self.centred else [1 + j]
            standing = [row for row in rows if not fell[row]] + [0]
            if len(standing) == 1:
                lost.append(j)
                continue
            a, b = standing[0], standing[1]
            jacobian[:, j] = (values[a] - values[b]) / (tried[a, j] - tried[b, j])
        if lost and not self.centred:
            self.counters["retried"] += len(lost)
            other = np.repeat(origin[None], len(lost), axis=0)
            other[np.arange(len(lost)), lost] -= self.samples[lost]
            again, fell_again = sample(other)
            for i, j in enumerate(lost):
                if not fell_again[i]:
                    jacobian[:, j] = (values[0] - again[i]) / self.samples[j]
            lost = [j for i, j in enumerate(lost) if fell_again[i]]
        for j in lost:
            self.counters["dropped"] += 1
            jacobian[:, j] = 0.0 if good is None else good[:, j]
        return jacobian

    def _solve(self, jacobian: Array, error: Array) -> Array:
        """Return dK (r,) of the damped, weighted least squares, in units of the scalings."""
        scaled = self.weights[:, None] * jacobian * self.samples
        normal = scaled.T @ scaled + self.regularisation * np.eye(len(error))
        wanted = scaled.T @ (self.weights * error)
        return self.samples * np.linalg.lstsq(normal, wanted, rcond=None)[0]
