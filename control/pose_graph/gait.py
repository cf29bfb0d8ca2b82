"""A gait ready to run: its pose graph and perturbations as arrays over a robot's joints."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from windup.control.pose_graph.gait_checks import check_gait
from windup.control.pose_graph.gait_file import GaitFile, Perturbation, Pose, State
from windup.control.pose_graph.pose_graph import FOREVER, PoseGraph, RelativeGraph
from windup.hal.config import load_toml
from windup.hal.contacts import ContactSensors
from windup.hal.errors import ConfigError, UnknownNameError
from windup.hal.joints import Array, Joints, Mask
from windup.hal.mirror import other_side

Mirroring = Callable[[Array], Array]
"""Returns the mirror image of joint positions (n,), such as a `windup.hal.mirror.Mirror`."""


@dataclass(frozen=True)
class Gait:
    """A pose graph with its perturbations, over n joints.

    Attributes:
        name: Name of the file, without suffix.
        file: The decoded gait file.
        graph: The base graph B.
        perturbations: Names of the p perturbations.
        pose_change: (p, s, n) change of the poses for a scaling of 1, rad.
        hold_change: (p, s) change of the hold times for a scaling of 1, s.
    """

    name: str
    file: GaitFile
    graph: PoseGraph
    perturbations: tuple[str, ...]
    pose_change: Array
    hold_change: Array

    def index(self, name: str) -> int:
        """Return the index of a perturbation.

        Raises:
            UnknownNameError: The gait has no such perturbation.
        """
        if name not in self.perturbations:
            raise UnknownNameError("perturbation", name, self.perturbations)
        return self.perturbations.index(name)

    def relative(self, name: str) -> RelativeGraph:
        """Return the perturbation `name` as a relative graph dP."""
        row = self.index(name)
        return RelativeGraph(self.pose_change[row], self.hold_change[row])


def load_gait(path: Path, joints: Joints, contacts: ContactSensors, mirror: Mirroring) -> Gait:
    """Return the gait in the file at `path` for a robot with these joints and contacts.

    Args:
        path: The file.
        joints: The joints.
        contacts: The contact sensors.
        mirror: Mirrors a pose left to right; called only if the file needs it.

    Raises:
        ConfigError: The file does not fit its format, the robot, or the joint limits.
    """
    file = load_toml(path, GaitFile)
    check_gait(path, file, joints)
    reader = _Reader(path, file, joints, contacts, mirror)
    graph = reader.graph()
    pose, hold = reader.perturbations(graph)
    return Gait(path.stem, file, graph, _names(file), pose, hold)


@dataclass(frozen=True)
class _Reader:
    """Converts one gait file into arrays; every error names the file and the key."""

    path: Path
    file: GaitFile
    joints: Joints
    contacts: ContactSensors
    mirror: Mirroring

    def graph(self) -> PoseGraph:
        if not self.file.state:
            raise self._error("state", "a graph needs at least one state")
        states = list(self.file.state)
        poses = [self._state_pose(state) for state in states]
        if self.file.mirror:
            poses += [self.mirror(pose) for pose in poses]
            states += [_mirrored(state) for state in states]
        names = [state.name for state in states]
        if len(set(names)) < len(names):
            twice = next(name for name in names if names.count(name) > 1)
            raise self._error(f"state.{twice}", "this name stands twice; give each its own")
        return PoseGraph(
            names=tuple(names),
            pose=np.array(poses),
            hold=np.array([self._hold(state) for state in states]),
            sensors=np.array([self._sensors(state) for state in states], dtype=bool),
            timeout=np.array([_or_forever(state.until.timeout) for state in states]),
            successor=np.array([self._next(names, i, s) for i, s in enumerate(states)]),
            stance=np.array([self._foot(state) for state in states]),
            ends_step=np.array([state.ends_step for state in states]),
            origin=str(self.path),
        )

    def perturbations(self, graph: PoseGraph) -> tuple[Array, Array]:
        names = _names(self.file)
        pose = np.zeros((len(names), *graph.pose.shape))
        hold = np.zeros((len(names), len(graph)))
        for item in self.file.perturbation:
            row = names.index(item.name)
            change = np.radians(self._pose(item.pose, f"perturbation.{item.name}"))
            chosen = self._chosen(item, graph)
            foot = self._stance(item.stance, f"perturbation.{item.name}.stance")
            across = (-1.0 if item.opposite else 1.0) * self.mirror(change)
            for state in np.flatnonzero(chosen):
                same = foot < 0 or graph.stance[state] == foot
                pose[row, state] += change if same else across
            hold[row, chosen & np.isfinite(graph.hold)] += item.hold
        return pose, hold

    def _chosen(self, item: Perturbation, graph: PoseGraph) -> Mask:
        """Return (s,) bool: the states that a perturbation applies to."""
        if item.states is None:
            return np.ones(len(graph), dtype=bool)
        chosen = np.zeros(len(graph), dtype=bool)
        for name in item.states:
            for known in (name, _mirrored_name(name)) if self.file.mirror else (name,):
                if known not in graph.names:
                    where = f"perturbation.{item.name}.states"
                    raise self._unknown(where, UnknownNameError("state", known, graph.names))
                chosen[graph.names.index(known)] = True
        return chosen

    def _state_pose(self, state: State) -> Array:
        """Return the pose (n,) of a state, rad, checked against the joint limits."""
        where = f"state.{state.name}.pose"
        degrees = self._pose(self.file.pose, "pose") + self._pose(state.pose, where)
        pose = np.radians(degrees)
        inside = (pose >= self.joints.lower - 1e-9) & (pose <= self.joints.upper + 1e-9)
        outside = ~inside
        if outside.any():
            j = int(np.flatnonzero(outside)[0])
            low, high = np.degrees([self.joints.lower[j], self.joints.upper[j]])
            raise self._error(
                f"{where}.{self.joints.names[j]}",
                f"{degrees[j]:g} degrees is outside the joint's limits {low:.1f} .. {high:.1f}",
            )
        return pose

    def _pose(self, pose: Pose, where: str) -> Array:
        """Return (n,) degrees from a table by joint name, or from a row in `columns` order."""
        if isinstance(pose, list):
            columns = self.file.columns
            if len(pose) != len(columns):
                raise self._error(where, f"{len(pose)} values for {len(columns)} columns")
            pose = dict(zip(columns, pose, strict=True))
        try:
            return self.joints.array(pose)
        except UnknownNameError as error:
            raise self._unknown(where, error) from None

    def _hold(self, state: State) -> float:
        until = state.until
        if (until.time is None) == (until.contact is None):
            where = f"state.{state.name}.until"
            raise self._error(where, "give either `time` or `contact`, and only one of them")
        return _or_forever(until.time)

    def _sensors(self, state: State) -> Mask:
        if state.until.contact is None:
            return np.zeros(len(self.contacts.names), dtype=bool)
        try:
            return self.contacts.mask(state.until.contact)
        except UnknownNameError as error:
            raise self._unknown(f"state.{state.name}.until.contact", error) from None

    def _next(self, names: list[str], index: int, state: State) -> int:
        if state.next is not None:
            if state.next not in names:
                where = f"state.{state.name}.next"
                raise self._unknown(where, UnknownNameError("state", state.next, names))
            return names.index(state.next)
        last = index + 1 == len(names)
        return index if last and not self.file.loop else (index + 1) % len(names)

    def _foot(self, state: State) -> int:
        return self._stance(state.stance, f"state.{state.name}.stance")

    def _stance(self, foot: str | None, where: str) -> int:
        if foot is None:
            return -1
        if foot not in self.contacts.feet:
            raise self._unknown(where, UnknownNameError("foot", foot, self.contacts.feet))
        return self.contacts.foot_names.index(foot)

    def _error(self, where: str, message: str) -> ConfigError:
        return ConfigError(f"{self.path}: {where}: {message}")

    def _unknown(self, where: str, error: UnknownNameError) -> ConfigError:
        return self._error(where, str(error))


def _names(file: GaitFile) -> tuple[str, ...]:
    """Return the names of the perturbations without repetitions."""
    return tuple(dict.fromkeys(item.name for item in file.perturbation))


def _or_forever(seconds: float | None) -> float:
    return FOREVER if seconds is None else seconds


def _mirrored_name(name: str) -> str:
    return f"{name}'"


def _mirrored(state: State) -> State:
    """Return the mirrored state, without its pose."""
    until = state.until
    if until.contact is not None:
        until = type(until)(contact=other_side(until.contact), timeout=until.timeout)
    return State(
        name=_mirrored_name(state.name),
        until=until,
        stance=None if state.stance is None else other_side(state.stance),
        ends_step=state.ends_step,
    )
