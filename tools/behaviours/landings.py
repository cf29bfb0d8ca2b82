"""Where the feet of a twin come down, and whether that was forbidden."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from shapely.geometry.base import BaseGeometry

from windup.control.execution.footing import Footing
from windup.control.footprints.keep_out import KeepOutRegions
from windup.control.kinematics.rotation import yaw_of
from windup.hal.joints import Array
from windup.hal.observation import Observation
from windup.tools.robot.robot import Robot

OFF = 0.05
"""A foot that touches again has stepped when it had been off the ground for so long, s."""


@dataclass
class Landings:
    """Watches a twin's feet, by the truth.

    Attributes:
        robot: The robot.
        footing: Its feet.
        regions: Where none may come down, seen from the middle between them at the start.
        falls: Where they came down.
        inside: Names of the feet that have touched forbidden ground.
    """

    robot: Robot
    footing: Footing
    regions: Sequence[BaseGeometry]
    falls: list[dict[str, Any]] = field(default_factory=list)
    inside: list[str] = field(default_factory=list)
    _touched: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        description, model = self.robot.description, self.robot.twin.model
        self._names = [foot.name for foot in description.feet]
        self._bodies = [model.body(foot.body).id for foot in description.feet]
        self._sites = [model.site(foot.site).id for foot in description.feet]

    def update(self, observation: Observation) -> None:
        """Look at the feet now."""
        now = observation.time
        if not self._touched:
            self._begin(observation)
        for foot, points in enumerate(self._contacts()):
            if not len(points):
                continue
            if now - self._touched[foot] > OFF:
                self.falls.append(self._fall(foot, now))
            if self._no_step.covers(points):
                self._note(foot)
            self._touched[foot] = now

    def _note(self, foot: int) -> None:
        """Note that a foot touches forbidden ground."""
        name = self._names[foot]
        if name not in self.inside:
            self.inside.append(name)
        steps = [fall for fall in self.falls if fall["foot"] == name]
        if steps:
            steps[-1]["forbidden"] = True

    def record(self) -> dict[str, Any]:
        """Return where the feet came down, and which ones touched forbidden ground."""
        landed = sum(fall["forbidden"] for fall in self.falls)
        return {"landings": self.falls, "landed_forbidden": landed, "on_forbidden": self.inside}

    def _begin(self, observation: Observation) -> None:
        self.footing.update(replace(observation, base=self.robot.twin.base))
        self._no_step = KeepOutRegions(self.regions)
        feet = range(len(self._names))
        self._no_step.begin(self.footing.feet, [self.footing.ground(foot) for foot in feet])
        self._touched = [observation.time for _ in feet]

    def _contacts(self) -> list[Array]:
        """Return where (p, 3) m each foot touches the ground."""
        twin = self.robot.twin
        count = twin.data.ncon
        bodies = twin.model.geom_bodyid[twin.data.contact.geom[:count]]
        deep = twin.data.contact.dist[:count] <= 0.0
        points = twin.data.contact.pos[:count]
        grounded = deep & (bodies.min(axis=1) == 0)
        return [points[grounded & (bodies.max(axis=1) == body)] for body in self._bodies]

    def _fall(self, foot: int, now: float) -> dict[str, Any]:
        data = self.robot.twin.data
        x, y, _ = data.site_xpos[self._sites[foot]]
        yaw = yaw_of(data.site_xmat[self._sites[foot]].reshape(3, 3))
        place = {"x": float(x), "y": float(y), "yaw_deg": float(np.degrees(yaw))}
        return {"foot": self._names[foot], "time": now, **place, "forbidden": False}


def format_landings(row: dict[str, Any]) -> str:
    """Return where the feet came down, for people, from a result with `Landings.record`."""
    falls = [f"{fall['foot']} at ({fall['x']:.3f}, {fall['y']:.3f}) m" for fall in row["landings"]]
    where = ", ".join(falls) if falls else "no foot was lifted"
    if row["on_forbidden"]:
        return f"{where}; forbidden ground was touched by {' and '.join(row['on_forbidden'])}"
    return f"{where}; none on forbidden ground"
