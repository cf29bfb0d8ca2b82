"""Numbers of a gait file that an optimiser may change (genes), by name.

    pose.STATE.JOINT       an angle of a state, degrees
    hold.STATE             its hold time, s
    target.VARIABLE        the target of a regulation variable
    limit.PERTURBATION     the largest amount of a perturbation that balance may apply
    change.PERTURBATION.JOINT   the effect of a perturbation on a joint, degrees per degree

If the second half of a graph is the first on the other foot, that is preserved: its genes have the
names of the first half and change both. If all poses are their own mirror images, the genes of the
left side change both sides.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from fnmatch import fnmatchcase
from typing import Any

import msgspec
import numpy as np

from windup.control.pose_graph.gait_file import GaitFile, State
from windup.hal.errors import UsageError
from windup.hal.joints import Array, Joints
from windup.hal.mirror import Mirror, other_side

SPREAD = {"pose": 4.0, "hold": 0.02, "target": 0.03, "limit": 4.0, "change": 0.2}
DIGITS = {"pose": 2, "hold": 4, "target": 4, "limit": 2, "change": 3}
LONGEST = 2.0  # longest time in a state, s


@dataclass(frozen=True)
class Gene:
    """One number of a gait file.

    Attributes:
        name: Name of the gene.
        value: Value in the file.
        spread: Standard deviation of the first guesses around it.
        lower: Smallest value.
        upper: Largest value.
    """

    name: str
    value: float
    spread: float
    lower: float = -np.inf
    upper: float = np.inf

    @property
    def kind(self) -> str:
        """Kind of the number: pose, hold and so on."""
        return self.name.partition(".")[0]

    def round(self, value: float) -> float:
        """Return `value` as written to a file: within the bounds, and rounded."""
        return round(float(np.clip(value, self.lower, self.upper)), DIGITS[self.kind])


class Genome:
    """The genes of a gait file.

    Args:
        file: The gait file.
        joints: The robot's joints.
        mirror: The robot's left-right symmetry.
    """

    def __init__(self, file: GaitFile, joints: Joints, mirror: Mirror) -> None:
        self.joints, self.mirror = joints, mirror
        self.file = _with_tables(file)
        self._half = _half(self.file)
        poses = np.array([joints.array(_named(state)) for state in self.file.state])
        self._even = not self.file.mirror and np.allclose(poses, mirror(poses))
        self.genes = {gene.name: gene for gene in self._all()}

    def choose(self, patterns: Iterable[str] | None = None) -> list[Gene]:
        """Return the genes that match `patterns`, where * stands for anything.

        Without patterns: the angles of the joints that the graph moves, the hold times, and the
        targets.

        Raises:
            UsageError: A pattern matches no gene.
        """
        if patterns is None:
            return self._usual()
        chosen: dict[str, Gene] = {}
        for pattern in patterns:
            fitting = [name for name in self.genes if fnmatchcase(name, pattern)]
            if not fitting:
                raise UsageError(f"--vary {pattern}: {_hint(pattern, self.genes)}")
            chosen |= {name: self.genes[name] for name in fitting}
        return list(chosen.values())

    def express(self, values: dict[str, float]) -> GaitFile:
        """Return the gait file with these values of the named genes."""
        data = msgspec.to_builtins(self.file)
        names = [state.name for state in self.file.state]
        for name, value in values.items():
            kind, _, where = name.partition(".")
            if kind == "pose":
                state, joint = where.rsplit(".", 1)
                self._pose(data, names.index(state), joint, value)
            elif kind == "hold":
                for index in self._both(names.index(where)):
                    data["state"][index]["until"]["time"] = value
            elif kind == "target":
                data["balance"]["targets"][where] = value
            else:
                _perturb(data["perturbation"], kind, where, value)
        return msgspec.convert(data, GaitFile)

    def _all(self) -> Iterable[Gene]:
        file = self.file
        base = self.joints.array(file.pose)
        lower, upper = np.degrees(self.joints.lower) - base, np.degrees(self.joints.upper) - base
        for state in file.state[: self._half]:
            pose = self.joints.array(_named(state))
            for j, joint in enumerate(self.joints.names):
                if self._even and (joint.startswith("r_") or self._odd(j)):
                    continue
                low, high = np.ceil(100.0 * lower[j]) / 100.0, np.floor(100.0 * upper[j]) / 100.0
                yield _gene(f"pose.{state.name}.{joint}", pose[j], float(low), float(high))
        for state in file.state[: self._half]:
            if state.until.time is not None:
                yield _gene(f"hold.{state.name}", state.until.time, 0.0, LONGEST)
        for name, value in (file.balance.targets if file.balance else {}).items():
            yield _gene(f"target.{name}", value)
        for item in file.perturbation:
            yield _gene(f"limit.{item.name}", item.limit, 0.0)
            for joint, value in item.pose.items():
                yield _gene(f"change.{item.name}.{joint}", value)

    def _usual(self) -> list[Gene]:
        poses = [self.joints.array(_named(state)) for state in self.file.state]
        both = np.abs(poses).max(axis=0)
        both = np.maximum(both, both[self.mirror.perm])
        moving = {name for name, angle in zip(self.joints.names, both, strict=True) if angle > 0.0}
        usual = []
        for gene in self.genes.values():
            still = gene.kind == "pose" and gene.name.rpartition(".")[2] not in moving
            if gene.kind in ("pose", "hold", "target") and not still:
                usual.append(gene)
        return usual

    def _odd(self, j: int) -> bool:
        """Return whether joint `j` is central, and 0 in every pose that is its own mirror image."""
        return int(self.mirror.perm[j]) == j and self.mirror.sign[j] < 0.0

    def _both(self, index: int) -> list[int]:
        """Return the index of a state and, in a graph of two halves, of its partner."""
        twice = self._half < len(self.file.state)
        return [index, index + self._half] if twice else [index]

    def _pose(self, data: dict[str, Any], index: int, joint: str, value: float) -> None:
        j = self.joints.names.index(other_side(joint))
        mirrored = {self.joints.names[j]: float(self.mirror.sign[j]) * value}
        data["state"][index]["pose"] |= {joint: value} | (mirrored if self._even else {})
        for partner in self._both(index)[1:]:
            data["state"][partner]["pose"] |= mirrored


def _gene(name: str, value: float, lower: float = -np.inf, upper: float = np.inf) -> Gene:
    return Gene(name, float(value), SPREAD[name.partition(".")[0]], lower, upper)


def _named(state: State) -> dict[str, float]:
    assert isinstance(state.pose, dict), "_with_tables has seen to it"
    return state.pose


def _with_tables(file: GaitFile) -> GaitFile:
    """Return the file with poses by joint name instead of rows of columns."""
    states = []
    for state in file.state:
        pose = state.pose
        if isinstance(pose, list):
            pose = {n: v for n, v in zip(file.columns, pose, strict=True) if v != 0.0}
        states.append(msgspec.structs.replace(state, pose=pose))
    return msgspec.structs.replace(file, state=states, columns=[])


def _half(file: GaitFile) -> int:
    """Return the number of states with genes: half if the other half is their mirror image."""
    count = len(file.state) // 2
    one, other = file.state[:count], file.state[count:]
    if file.mirror or len(one) != len(other):
        return len(file.state)
    feet = [(a.stance, b.stance) for a, b in zip(one, other, strict=True)]
    alternate = all(a is not None and b == other_side(a) != a for a, b in feet)
    return count if alternate else len(file.state)


def _perturb(items: list[dict[str, Any]], kind: str, where: str, value: float) -> None:
    for item in items:
        if kind == "limit" and item["name"] == where:
            item["limit"] = value
        elif kind == "change":
            name, joint = where.rsplit(".", 1)
            if item["name"] == name and joint in item["pose"]:
                item["pose"][joint] = value


def _hint(pattern: str, names: Iterable[str]) -> str:
    """Return a message for a pattern that matches nothing, with a suggestion."""
    near = get_close_matches(pattern, names, n=1)
    kinds = ", ".join(f"'{kind}.*'" for kind in SPREAD)
    return f"fits nothing; did you mean {near[0]!r}?" if near else f"fits nothing; try {kinds}"


def shape(genes: list[Gene]) -> tuple[Array, Array, Array]:
    """Return values and bounds (g,) of genes, in spreads relative to the file's values."""
    value, spread = np.array([g.value for g in genes]), np.array([g.spread for g in genes])
    lower, upper = np.array([g.lower for g in genes]), np.array([g.upper for g in genes])
    return np.zeros(len(genes)), (lower - value) / spread, (upper - value) / spread
