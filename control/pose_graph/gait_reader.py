"""Conversion of a gait file to arrays: its graph and perturbations over a robot's joints."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from windup.control.pose_graph.gait_file import GaitFile, Perturbation, Pose, State
from windup.control.pose_graph.pose_graph import FOREVER, PoseGraph
from windup.hal.contacts import ContactSensors
from windup.hal.errors import ConfigError, UnknownNameError
from windup.hal.joints import Array, Joints, Mask
from windup.hal.mirror import other_side

Mirroring = Callable[[Array], Array]
"""Returns the mirror image of joint positions (n,), such as a `windup.hal.mirror.Mirror`."""


@dataclass(frozen=True)
class GaitReader:
    """Converts one gait file into arrays; every error names the file and the key.

    Attributes:
        path: The file.
        file: The decoded gait file.
        joints: The robot's joints.
        contacts: Its contact sensors.
        mirror: Mirrors a pose left to right; called only if the file needs it.
    """

    path: Path
    file: GaitFile
    joints: Joints
    contacts: ContactSensors
    mirror: Mirroring

    @property
    def state_names(self) -> tuple[str, ...]:
        """Names of all states, including the mirrored ones."""
        names = [state.name for state in self.file.state]
        return (*names, *map(_mirrored_name, names)) if self.file.mirror else tuple(names)

    @property
    def perturbation_names(self) -> tuple[str, ...]:
        """Names of the perturbations without repetitions."""
        return tuple(dict.fromkeys(item.name for item in self.file.perturbation))

    def graph(self) -> PoseGraph:
        """Return the pose graph.

        Raises:
            ConfigError: A state is invalid.
        """
        states, names = list(self.file.state), self.check_names()
        poses = [self.pose_of(state) for state in states]
        if self.file.mirror:
            poses += [self.mirror(pose) for pose in poses]
            states += [_mirrored(state) for state in states]
        return PoseGraph(
            names=names,
            pose=np.array(poses),
            hold=np.array([self.hold_of(state) for state in states]),
            sensors=np.array([self.sensors_of(state) for state in states], dtype=bool),
            timeout=np.array([_or_forever(state.until.timeout) for state in states]),
            successor=np.array([self.next_of(i, s) for i, s in enumerate(states)]),
            stance=np.array([self.foot_of(state) for state in states]),
            ends_step=np.array([state.ends_step for state in states]),
            origin=str(self.path),
        )

    def perturbations(self, graph: PoseGraph) -> tuple[Array, Array]:
        """Return the changes (p, s, n) rad of poses and (p, s) s of hold times, for a scaling of 1.

        Raises:
            ConfigError: A perturbation is invalid.
        """
        names = self.perturbation_names
        pose = np.zeros((len(names), *graph.pose.shape))
        hold = np.zeros((len(names), len(graph)))
        for item in self.file.perturbation:
            row = names.index(item.name)
            change, foot, chosen = self.parts_of(item)
            across = (-1.0 if item.opposite else 1.0) * self.mirror(change)
            for state in np.flatnonzero(chosen):
                same = foot < 0 or graph.stance[state] == foot
                pose[row, state] += change if same else across
            hold[row, chosen & np.isfinite(graph.hold)] += item.hold
        return pose, hold

    def parts_of(self, item: Perturbation) -> tuple[Array, int, Mask]:
        """Return change (n,) rad, foot and chosen states (s,) of a perturbation.

        Raises:
            ConfigError: It names an unknown joint, foot or state.
        """
        where = f"perturbation.{item.name}"
        change = np.radians(self._pose(item.pose, where))
        chosen = self._chosen(item)
        return change, self._stance(item.stance, f"{where}.stance"), chosen

    def check_names(self) -> tuple[str, ...]:
        """Return the names of all states.

        Raises:
            ConfigError: There is no state, or two have one name.
        """
        names = self.state_names
        if not names:
            raise self._error("state", "a graph needs at least one state")
        if len(set(names)) < len(names):
            twice = next(name for name in names if names.count(name) > 1)
            raise self._error(f"state.{twice}", "this name stands twice; give each its own")
        return names

    def pose_of(self, state: State) -> Array:
        """Return the pose (n,) rad of a state.

        Raises:
            ConfigError: It names an unknown joint, or is outside of the joint limits.
        """
        for error in self.limit_errors(state):
            raise error
        return np.radians(self._degrees(state))

    def limit_errors(self, state: State) -> list[ConfigError]:
        """Return an error for each joint outside its limits in the pose of a state.

        Raises:
            ConfigError: It names an unknown joint.
        """
        degrees = self._degrees(state)
        pose, low, high = np.radians(degrees), self.joints.lower, self.joints.upper
        inside = (pose >= low - 1e-9) & (pose <= high + 1e-9)
        return [
            self._error(
                f"state.{state.name}.pose.{self.joints.names[j]}",
                f"{degrees[j]:g} degrees is outside the joint's limits "
                f"{np.degrees(low[j]):.1f} .. {np.degrees(high[j]):.1f}",
            )
            for j in np.flatnonzero(~inside)
        ]

    def _degrees(self, state: State) -> Array:
        """Return the pose (n,) of a state, degrees."""
        own = self._pose(state.pose, f"state.{state.name}.pose")
        return self._pose(self.file.pose, "pose") + own

    def _chosen(self, item: Perturbation) -> Mask:
        """Return (s,) bool: the states that a perturbation applies to."""
        names = self.state_names
        if item.states is None:
            return np.ones(len(names), dtype=bool)
        chosen = np.zeros(len(names), dtype=bool)
        for name in item.states:
            for known in (name, _mirrored_name(name)) if self.file.mirror else (name,):
                if known not in names:
                    where = f"perturbation.{item.name}.states"
                    raise self._unknown(where, UnknownNameError("state", known, names))
                chosen[names.index(known)] = True
        return chosen

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

    def hold_of(self, state: State) -> float:
        """Return how long a state is held, s.

        Raises:
            ConfigError: It has neither a time nor a contact, or both.
        """
        until = state.until
        if (until.time is None) == (until.contact is None):
            where = f"state.{state.name}.until"
            raise self._error(where, "give either `time` or `contact`, and only one of them")
        return _or_forever(until.time)

    def sensors_of(self, state: State) -> Mask:
        """Return (k,) bool: the contact sensors that end a state.

        Raises:
            ConfigError: The robot has no such sensor or foot.
        """
        if state.until.contact is None:
            return np.zeros(len(self.contacts.names), dtype=bool)
        try:
            return self.contacts.mask(state.until.contact)
        except UnknownNameError as error:
            raise self._unknown(f"state.{state.name}.until.contact", error) from None

    def next_of(self, index: int, state: State) -> int:
        """Return the index of the state that follows the state at `index`.

        Raises:
            ConfigError: There is no such state.
        """
        names = self.state_names
        if state.next is not None:
            if state.next not in names:
                where = f"state.{state.name}.next"
                raise self._unknown(where, UnknownNameError("state", state.next, names))
            return names.index(state.next)
        last = index + 1 == len(names)
        return index if last and not self.file.loop else (index + 1) % len(names)

    def foot_of(self, state: State) -> int:
        """Return the index of the stance foot of a state, -1 for none.

        Raises:
            ConfigError: The robot has no such foot.
        """
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
