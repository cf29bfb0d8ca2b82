"""Measures trunk impact speed and servo load at every physics step of a twin."""

from collections import deque
from dataclasses import dataclass, field

import mujoco
import numpy as np

from windup.hal.joints import Array
from windup.sim_twin.twin import Twin

HEADS = ("head", "neck")
"""Substrings of body names that count as head: not torso, but as fragile."""
JUMP_WINDOW = 0.01
"""Window over which the torso's velocity change is measured, s."""


@dataclass
class ImpactGauge:
    """Measures impacts and loads of a twin from its construction on.

    Attributes:
        twin: The twin.
        torso: Greatest downward speed of a torso point at the moment it touched the floor, m/s; 0
            when the torso never touched it.
        head: The same for head and neck.
        velocity_jump: Greatest change of the torso's velocity in 10 ms, m/s; includes shocks that
            limbs transmit when they hit the floor.
        load: (n,) greatest torque of each joint's actuator, as a share of its limit (for a servo:
            the stall torque); 0 for joints without a limit.
        overload: Longest uninterrupted time that one joint exceeded its torque limit, s.
    """

    twin: Twin
    torso: float = field(default=0.0, init=False)
    head: float = field(default=0.0, init=False)
    velocity_jump: float = field(default=0.0, init=False)
    overload: float = field(default=0.0, init=False)

    def __post_init__(self) -> None:
        twin, joints = self.twin, self.twin.robot.joints
        self.load = np.zeros(len(joints))
        self._over = np.zeros(len(joints))
        self._limit = joints.torque
        solid = np.flatnonzero(twin.model.geom_conaffinity > 0)
        names = [twin.model.body(int(twin.model.geom_bodyid[geom])).name for geom in solid]
        pairs = list(zip(solid.tolist(), names, strict=True))
        self._torso = {geom for geom, name in pairs if name == twin.robot.torso}
        self._head = {geom for geom, name in pairs if any(part in name for part in HEADS)}
        self._body = twin.model.body(twin.robot.torso).id
        self._past: deque[Array] = deque(maxlen=1 + round(JUMP_WINDOW / twin.timestep))
        self._before: dict[int, tuple[Array, Array]] = {}
        self._also, twin.on_step = twin.on_step, self._update

    @property
    def trunk_speed(self) -> float:
        """The greater of the torso and head impact speeds, m/s."""
        return max(self.torso, self.head)

    @property
    def most_loaded_joint(self) -> str:
        """Name of the joint with the greatest load."""
        return self.twin.robot.joints.names[int(self.load.argmax())]

    def _update(self) -> None:
        if self._also is not None:
            self._also()
        data = self.twin.data
        touching = (contact for contact in data.contact if contact.dist <= 0.0)
        for contact in touching:
            geom = int(contact.geom.max())  # the floor is the first geom
            if geom in self._before:
                self._touched(geom, contact.pos)
        self._before = {geom: self._motion(geom) for geom in self._torso | self._head}
        self._past.append(self._velocity(mujoco.mjtObj.mjOBJ_BODY, self._body)[3:])
        self.velocity_jump = max(
            self.velocity_jump, float(np.linalg.norm(self._past[-1] - self._past[0]))
        )
        self._work()

    def _touched(self, geom: int, point: Array) -> None:
        """Record the speed of a geom's point one step earlier, before the floor stopped it."""
        velocity, centre = self._before[geom]
        speed = -float((velocity[3:] + np.cross(velocity[:3], point - centre))[2])
        if geom in self._torso:
            self.torso = max(self.torso, speed)
        else:
            self.head = max(self.head, speed)

    def _motion(self, geom: int) -> tuple[Array, Array]:
        """Return a geom's velocity (6,) and centre (3,) in the world frame."""
        velocity = self._velocity(mujoco.mjtObj.mjOBJ_GEOM, geom)
        return velocity, self.twin.data.geom_xpos[geom].copy()

    def _velocity(self, kind: mujoco.mjtObj, index: int) -> Array:
        """Return an object's velocity (6,) at its centre in the world frame, rad/s before m/s."""
        velocity = np.empty(6)
        mujoco.mj_objectVelocity(self.twin.model, self.twin.data, kind, index, velocity, 0)
        return velocity

    def _work(self) -> None:
        share = np.abs(self.twin.data.actuator_force) / self._limit
        self.load = np.maximum(self.load, share)
        self._over = np.where(share > 1.0, self._over + self.twin.timestep, 0.0)
        self.overload = max(self.overload, float(self._over.max()))
