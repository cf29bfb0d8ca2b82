"""The ground of a twin: flat, sloping, strips or stairs across the path, or rough all over."""

from dataclasses import dataclass
from math import cos, radians, sin, tan

import mujoco
import numpy as np

from windup.hal.errors import UsageError
from windup.hal.joints import Array
from windup.sim_twin.ground.rough import RoughGround

WIDE = 20.0  # half the width of a tile, m
DEEP = 0.25  # half the thickness of a tile, m
BEHIND = 3.0  # length of the flat ground before `start`, m
SLOPE_TILE = 4.0
TILES = 60


@dataclass(frozen=True)
class Ground:
    """Flat ground around the start, followed by one kind of terrain ahead.

    Attributes:
        slope: Inclination, degrees; positive is uphill.
        strips: Largest height of a strip above or below the start, m.
        stairs: Height of each stair, m; positive is up.
        rough: Largest height of a node of rough ground above or below the start, m.
        start: x where the flat ground ends, m.
        strip: Length of a strip, m; a stair is twice as long, and nodes are half as far apart.
        seed: Seed of the random heights.
    """

    slope: float = 0.0
    strips: float = 0.0
    stairs: float = 0.0
    rough: float = 0.0
    start: float = 0.5
    strip: float = 0.25
    seed: int = 0

    @property
    def flat(self) -> bool:
        """True when the ground is a single plane."""
        return not (self.slope or self.strips or self.stairs or self.rough)

    @property
    def tiles(self) -> Array:
        """Tiles (t, 2) after the flat start: x where each begins, and its height there, m."""
        if self.strips:
            count = TILES * 4
            heights = np.random.default_rng(self.seed).uniform(-self.strips, self.strips, count)
            return np.stack([self.start + self.strip * np.arange(count), heights], axis=1)
        if self.stairs:
            x = self.start + self.length * np.arange(TILES * 2)
            return np.stack([x, self.stairs * np.arange(1, len(x) + 1)], axis=1)
        x = SLOPE_TILE * np.arange(TILES)
        return np.stack([self.start + x, x * tan(radians(self.slope))], axis=1)

    @property
    def length(self) -> float:
        """Length of a tile along x, m."""
        if self.stairs:
            return 2.0 * self.strip
        return self.strip if self.strips else SLOPE_TILE

    def height(self, x: float, y: float = 0.0) -> float:
        """Return the height of the ground at (x, y) m.

        >>> round(Ground(slope=45.0, start=1.0).height(3.0), 3)
        2.0
        """
        if self.flat or x < self.start:
            return 0.0
        if self.slope:
            return (x - self.start) * tan(radians(self.slope))
        if self.rough:
            return self._rough.height(x, y)
        tiles = self.tiles
        return float(tiles[min(int((x - self.start) / self.length), len(tiles) - 1), 1])

    def build(self, spec: mujoco.MjSpec) -> None:
        """Replace the floor plane of `spec` by this ground, with the plane's friction and material.

        Raises:
            UsageError: `spec` has no floor plane.
        """
        if self.flat:
            return
        floor = next((g for g in spec.geoms if g.type == mujoco.mjtGeom.mjGEOM_PLANE), None)
        if floor is None:
            raise UsageError(
                "the MJCF has no plane that other ground could replace; add one as its floor"
            )
        begin = self.start - BEHIND
        self._tile(spec, floor, begin, 0.0, BEHIND, 0.0)
        if self.rough:
            self._rough.build(spec, floor)
        for x, height in () if self.rough else self.tiles:
            self._tile(spec, floor, float(x), float(height), self.length, radians(self.slope))
        spec.delete(floor)

    @property
    def _rough(self) -> RoughGround:
        return RoughGround(self.rough, 0.5 * self.strip, self.start, self.seed)

    def _tile(
        self,
        spec: mujoco.MjSpec,
        floor: mujoco.MjsGeom,
        x: float,
        height: float,
        length: float,
        pitch: float,
    ) -> None:
        """Add a box whose upper face begins at (x, height) m and rises at `pitch` rad."""
        half = 0.5 * length / cos(pitch)
        along = np.array([cos(pitch), 0.0, sin(pitch)])
        down = np.array([sin(pitch), 0.0, -cos(pitch)])
        centre = np.array([x, 0.0, height]) + half * along + DEEP * down
        spec.worldbody.add_geom(
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=[half, WIDE, DEEP],
            pos=centre,
            quat=[cos(0.5 * pitch), 0.0, -sin(0.5 * pitch), 0.0],
            contype=floor.contype,
            conaffinity=floor.conaffinity,
            friction=floor.friction,
            material=floor.material,
        )
