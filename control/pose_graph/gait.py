"""A gait ready to run: its pose graph and perturbations as arrays over a robot's joints."""

from dataclasses import dataclass
from pathlib import Path

from windup.control.pose_graph.gait_checks import table_mistakes
from windup.control.pose_graph.gait_file import GaitFile
from windup.control.pose_graph.gait_reader import GaitReader, Mirroring
from windup.control.pose_graph.pose_graph import PoseGraph, RelativeGraph
from windup.hal.config import load_toml
from windup.hal.contacts import ContactSensors
from windup.hal.errors import ConfigError, UnknownNameError
from windup.hal.joints import Array, Joints


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
    for key, mistake in table_mistakes(file, joints):
        raise ConfigError(f"{path}: {key}: {mistake}")
    reader = GaitReader(path, file, joints, contacts, mirror)
    graph = reader.graph()
    pose, hold = reader.perturbations(graph)
    return Gait(path.stem, file, graph, reader.perturbation_names, pose, hold)
