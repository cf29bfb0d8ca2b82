"""Detection of a wrong joint sign, or of swapped servo ids, by the attitude of the soles.

A servo whose sign is wrong in robot.toml, or whose id is swapped, is read as it is commanded, so
its position error stays small. But a robot that stands has both soles flat on the floor. If the
joint angles contradict that, and one wrong sign or one pair of swapped ids would make both soles
flat at rest and during the motion, then that is the mistake.

A robot that is held in somebody's hands may have its soles at any attitude. One wrong joint hardly
ever explains that throughout a motion, so no mistake is reported for such a robot.
"""

from itertools import combinations
from math import cos, radians

import mujoco
import numpy as np
import numpy.typing as npt

from windup.control.kinematics.legs import Legs
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation

OFF = radians(12.0)
"""Apparent tilt beyond which a sole does not lie on the floor, rad."""
FLAT = radians(2.5), radians(10.0)
"""Bounds of the mean tilt below which a sole counts as flat, rad: floors, IMUs and joint zeros are
no more exact than the lower one. Between them it is the largest apparent tilt over `BETTER`."""
BETTER = 8.0
MOVED = radians(4.0)
"""Minimum motion of a joint before it is reported, rad: a single pose may fit by chance."""
TURNED = radians(1.0)
"""Minimum rotation of the base before a joint is reported, rad; a hanging robot may not turn."""
APART = 0.1
"""Height difference of the soles that counts like a tilt of 1 rad, m."""
ALIKE = radians(1.0)
"""Maximum tilt of a hypothesis above that of the best one to be reported too, rad."""
EVERY = 5
"""Ticks from one check to the next."""

Indices = npt.NDArray[np.intp]


class Planted:
    """Checks the soles of one standing robot during a motion.

    Args:
        joints: The joints.
        legs: Kinematics of the soles.
    """

    def __init__(self, joints: Joints, legs: Legs) -> None:
        self._names, self._legs = joints.names, legs
        # The joints of each hypothesis: none, one with a wrong sign, or two with swapped ids.
        singles, pairs = combinations(legs.joints, 1), combinations(legs.joints, 2)
        self._guesses: list[tuple[int, ...]] = [(), *singles, *pairs]
        n = len(joints)
        self._take: Indices = np.tile(np.arange(n), (len(self._guesses), 1))
        self._sign: Array = np.ones((len(self._guesses), n))
        for row, guess in enumerate(self._guesses):
            if len(guess) == 1:
                self._sign[row, guess[0]] = -1.0
            elif guess:
                self._take[row, list(guess)] = guess[::-1]
        self._about = np.zeros((len(self._guesses), n), dtype=bool)
        for row, guess in enumerate(self._guesses):
            self._about[row, list(guess)] = True
        self.begin()

    def begin(self) -> None:
        """Start over, at the beginning of a motion."""
        self._start: Array | None = None
        self._ticks, self._looks, self._worst = 0, 0, 0.0
        self._sum: Array = np.zeros(len(self._guesses))

    def update(self, observation: Observation) -> str | None:
        """Return a message about the mistake in robot.toml, or None; call it at every tick."""
        self._ticks += 1
        base = observation.base
        if self._ticks % EVERY != 1 or base is None:
            return None
        position, frame = observation.joints.position, np.empty(9)
        mujoco.mju_quat2Mat(frame, base.orientation)
        up = frame[6:]
        if self._start is None:
            self._start, self._up = position, up
        off = self._off(position, up)
        self._sum += off
        self._looks += 1
        self._worst = max(self._worst, float(off[0]))
        if self._worst < OFF or up @ self._up > cos(TURNED):
            return None
        moved = np.where(self._about, np.abs(position - self._start), 0.0).max(axis=1)
        mean = self._sum / self._looks
        flat = min(max(self._worst / BETTER, FLAT[0]), FLAT[1])
        explains = (mean < min(flat, mean.min() + ALIKE)) & (off < 2.0 * flat) & (moved > MOVED)
        alike = np.flatnonzero(explains)
        return self._said(alike[np.argsort(mean[alike])][:2]) if alike.size else None

    def _off(self, position: Array, up: Array) -> Array:
        """Return for each hypothesis the deviation of the soles from one flat floor, rad."""
        poses = position[self._take] * self._sign
        normals, middles = self._legs.soles(poses)
        tilt = np.arccos(np.clip((normals @ up).min(axis=1), -1.0, 1.0))
        return np.asarray(np.maximum(tilt, np.ptp(middles @ up, axis=1) / APART))

    def _said(self, rows: Indices) -> str:
        """Return the message for the hypotheses at `rows`, the most likely first."""
        said = []
        for row in rows:
            names = [self._names[joint] for joint in self._guesses[row]]
            if len(names) == 1:
                said.append(f"{names[0]} turns the other way (is its sign right in robot.toml?)")
            else:
                said.append(f"{' and '.join(names)} are swapped (are their ids right there?)")
        seen = f"the soles seem {np.degrees(self._worst):.0f} degrees off the floor"
        return f"{', or '.join(said)}: {seen}"
