"""Rough ground: a height field with seeded random heights at the nodes of a square grid."""

from dataclasses import dataclass
from functools import lru_cache

import mujoco
import numpy as np

from windup.hal.joints import Array

LONG, WIDE = 400, 160  # number of cells along x and along y
DEEP = 0.25  # thickness of the solid ground below the lowest node, m


@dataclass(frozen=True)
class RoughGround:
    """Ground whose height at each node is uniform in -amplitude .. amplitude.

    Attributes:
        amplitude: Largest height above or below the flat ground, m.
        cell: Distance between neighbouring nodes, m.
        start: x where the height field begins, level with the flat ground, m.
        seed: Seed of the heights.
    """

    amplitude: float
    cell: float
    start: float
    seed: int = 0

    def height(self, x: float, y: float) -> float:
        """Return the height at (x, y) m, interpolated over a cell's two triangles as in MuJoCo."""
        nodes = _nodes(self.amplitude, self.seed)
        u = float(np.clip((x - self.start) / self.cell, 0.0, LONG - 1e-9))
        v = float(np.clip(y / self.cell + 0.5 * WIDE, 0.0, WIDE - 1e-9))
        column, row = int(u), int(v)
        u, v = u - column, v - row
        a, b = nodes[row, column], nodes[row, column + 1]
        c, d = nodes[row + 1, column], nodes[row + 1, column + 1]
        # The diagonal goes from c to b.
        if u + v <= 1.0:
            return float(a + u * (b - a) + v * (c - a))
        return float(d + (1.0 - u) * (c - d) + (1.0 - v) * (b - d))

    def build(self, spec: mujoco.MjSpec, floor: mujoco.MjsGeom) -> None:
        """Add the height field to `spec`, with the friction and material of `floor`."""
        nodes = _nodes(self.amplitude, self.seed)
        half = 0.5 * self.cell * np.array([LONG, WIDE])
        share = (nodes + self.amplitude) / (2.0 * self.amplitude)
        spec.add_hfield(
            name="rough",
            nrow=nodes.shape[0],
            ncol=nodes.shape[1],
            size=[half[0], half[1], 2.0 * self.amplitude, DEEP],
            userdata=share.ravel(),
        )
        spec.worldbody.add_geom(
            type=mujoco.mjtGeom.mjGEOM_HFIELD,
            hfieldname="rough",
            pos=[self.start + half[0], 0.0, -self.amplitude],
            contype=floor.contype,
            conaffinity=floor.conaffinity,
            friction=floor.friction,
            material=floor.material,
        )


@lru_cache(maxsize=4)
def _nodes(amplitude: float, seed: int) -> Array:
    """Return the node heights (WIDE + 1, LONG + 1), m."""
    random = np.random.default_rng(seed)
    nodes = random.uniform(-amplitude, amplitude, (WIDE + 1, LONG + 1))
    nodes[:, 0] = 0.0
    # MuJoCo normalises the heights to their range; these two corners fix it to +-amplitude.
    nodes[0, -1], nodes[-1, -1] = -amplitude, amplitude
    nodes.setflags(write=False)
    return nodes
