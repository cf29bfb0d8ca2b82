"""Do the soles lie on the floor as the joints say? If not: which sign or ids would explain it?

A servo is read as it is commanded, so one whose sign is wrong in robot.toml, or whose id is another
one's, follows its goals and is seen to. But a robot that stands has both soles flat on the floor.
Where the joints say that they are not, and one wrong sign, or two exchanged ids, would make both
lie flat, at rest and on the way, that is what is wrong.

A robot in somebody's hands has its soles anywhere: hardly ever does one wrong joint put both flat
and keep them so while it moves. Such robots are not judged, whatever is wrong with them.
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
"""A sole that seems tilted by more does not lie on the floor."""
FLAT = radians(2.5), radians(10.0)
"""One that is tilted by less on average does, for floors, IMUs and zeros are no better; and where
joints have it far off the floor, by less than an eighth of that."""
BETTER = 8.0
MOVED = radians(4.0)
"""So far a joint has to be moved before it is called wrong: chance explains one pose."""
TURNED = radians(1.0)
"""So far the base of a robot turns that stands on wrong joints; one that hangs may not turn."""
APART = 0.1
"""Soles of which one is higher by this are as far from one floor as one tilted by 1 rad, m."""
ALIKE = radians(1.0)
"""A guess that explains the soles worse than another one by more is none, rad."""
EVERY = 5
"""Ticks from one look to the next."""

Indices = npt.NDArray[np.intp]


class Planted:
    """Judges one robot on its feet.

    Args:
        joints: The joints.
        legs: Where its soles are.
    """

    def __init__(self, joints: Joints, legs: Legs) -> None:
        self._names, self._legs = joints.names, legs
        # Which joints each guess is about: none, one with a wrong sign, two with swapped ids.
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
        """Begin anew."""
        self._start: Array | None = None
        self._ticks, self._looks, self._worst = 0, 0, 0.0
        self._sum: Array = np.zeros(len(self._guesses))

    def update(self, observation: Observation) -> str | None:
        """Return what must be wrong in robot.toml, for people, or None; call it every tick."""
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
        """Return for each guess how far the soles are from lying on one floor, rad."""
        poses = position[self._take] * self._sign
        normals, middles = self._legs.soles(poses)
        tilt = np.arccos(np.clip((normals @ up).min(axis=1), -1.0, 1.0))
        return np.asarray(np.maximum(tilt, np.ptp(middles @ up, axis=1) / APART))

    def _said(self, rows: Indices) -> str:
        """Return in words what the guesses at `rows` say, the likelier one first."""
        said = []
        for row in rows:
            names = [self._names[joint] for joint in self._guesses[row]]
            if len(names) == 1:
                said.append(f"{names[0]} turns the other way (is its sign right in robot.toml?)")
            else:
                said.append(f"{' and '.join(names)} are swapped (are their ids right there?)")
        seen = f"the soles seem {np.degrees(self._worst):.0f} degrees off the floor"
        return f"{', or '.join(said)}: {seen}"
