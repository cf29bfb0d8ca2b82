"""Forward kinematics of a robot's flat soles, for many poses at once."""

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from windup.control.kinematics.soles import spin
from windup.hal.joints import Array, Joints

Indices = npt.NDArray[np.intp]


@dataclass(frozen=True)
class Legs:
    """The k legs of a robot as chains of joints; shorter chains are padded with fixed joints.

    The rotation of a joint's body in its parent frame is ``fixed + sin(q) across + (1 - cos(q))
    along``, the body's fixed rotation followed by Rodrigues' formula.

    Attributes:
        joints: Indices of all joints that move a sole.
        joint: (k, longest) joint indices along each chain.
        place: (k, longest, 3) position of the joint's body in its parent frame, m.
        fixed: (k, longest, 3, 3) see above.
        across: (k, longest, 3, 3) see above.
        along: (k, longest, 3, 3) see above.
        anchor: (k, longest, 3) a point of the joint's axis in the frame of its body, m.
        normal: (k, 3) upward normal of the sole in the frame of the foot.
        middle: (k, 3) centre of the sole in the frame of the foot, m.
    """

    joints: tuple[int, ...]
    joint: Indices
    place: Array
    fixed: Array
    across: Array
    along: Array
    anchor: Array
    normal: Array
    middle: Array

    def soles(self, position: Array) -> tuple[Array, Array]:
        """Return normals (m, k, 3) and centres (m, k, 3) m, in the base frame.

        Args:
            position: (m, n) joint positions of m poses, rad.
        """
        angle = position[:, self.joint, None, None]
        turn = self.fixed + np.sin(angle) * self.across + (1.0 - np.cos(angle)) * self.along
        still = self.place + (self.fixed @ self.anchor[..., None])[..., 0]
        shift = (still - (turn @ self.anchor[..., None])[..., 0])[..., None]
        frame, place = turn[:, :, 0], shift[:, :, 0]
        for row in range(1, self.joint.shape[1]):
            place = place + frame @ shift[:, :, row]
            frame = frame @ turn[:, :, row]
        middle = place + frame @ self.middle[..., None]
        return (frame @ self.normal[..., None])[..., 0], middle[..., 0]


def legs_of(
    model: mujoco.MjModel, base: str, feet: Sequence[str], joints: Joints, stance: Array
) -> Legs | None:
    """Return the legs of a robot, or None if it has no feet, or a foot without a flat sole.

    Args:
        model: The robot alone: a free joint, then n hinges in MJCF order.
        base: Name of the body with the free joint.
        feet: Names of the feet's bodies.
        joints: The joints.
        stance: (n,) rad; the sole of a foot is the lower face of its lowest box in this pose.
    """
    data = mujoco.MjData(model)
    data.qpos[:7] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    data.qpos[7:] = stance
    mujoco.mj_kinematics(model, data)
    bodies = [model.body(name).id for name in feet]
    soles = [sole for body in bodies if (sole := _sole(model, data, body)) is not None]
    if not bodies or len(soles) < len(bodies):
        return None
    chains = [_chain(model, model.body(base).id, body, joints) for body in bodies]
    k, longest = len(chains), max(map(len, chains))
    joint = np.zeros((k, longest), dtype=np.intp)
    place, anchor, zero = (
        np.zeros((k, longest, 3)),
        np.zeros((k, longest, 3)),
        np.zeros((k, longest, 3, 3)),
    )
    fixed, across, along = np.tile(np.eye(3), (k, longest, 1, 1)), zero, zero.copy()
    for leg, chain in enumerate(chains):
        for row, (index, where, turn, axis, point) in enumerate(chain):
            joint[leg, row], place[leg, row], anchor[leg, row] = index, where, point
            fixed[leg, row], across[leg, row] = turn, turn @ axis
            along[leg, row] = turn @ axis @ axis
    moving = tuple(sorted({index for chain in chains for index, *_ in chain}))
    normal, middle = (np.array(values) for values in zip(*soles, strict=True))
    return Legs(moving, joint, place, fixed, across, along, anchor, normal, middle)


Step = tuple[int, Array, Array, Array, Array]


def _chain(model: mujoco.MjModel, base: int, body: int, joints: Joints) -> list[Step]:
    """Return the joints from the base to a foot: index, place, rotation, axis matrix, anchor."""
    way = []
    while body != base:
        way.append(body)
        body = int(model.body_parentid[body])
    steps: list[Step] = []
    place, fixed = np.zeros(3), np.eye(3)
    for part in reversed(way):
        turn = np.empty(9)
        mujoco.mju_quat2Mat(turn, model.body_quat[part])
        place, fixed = place + fixed @ model.body_pos[part], fixed @ turn.reshape(3, 3)
        for joint in np.flatnonzero(model.jnt_bodyid == part):
            index = joints.index(model.joint(int(joint)).name)
            axis, anchor = spin(model.jnt_axis[joint]), model.jnt_pos[joint].copy()
            steps.append((index, place, fixed, axis, anchor))
            place, fixed = np.zeros(3), np.eye(3)
    return steps


def _sole(model: mujoco.MjModel, data: mujoco.MjData, body: int) -> tuple[Array, Array] | None:
    """Return normal and centre (3,) of a sole in the frame of its foot; None without a box."""
    boxes = np.flatnonzero(
        (model.geom_bodyid == body)
        & (model.geom_type == mujoco.mjtGeom.mjGEOM_BOX)
        & ((model.geom_contype > 0) | (model.geom_conaffinity > 0))
    )
    if not boxes.size:
        return None
    lowest = boxes[int(data.geom_xpos[boxes, 2].argmin())]
    frame = data.geom_xmat[lowest].reshape(3, 3)
    face = int(np.abs(frame[2]).argmax())
    up = frame[:, face] * np.sign(frame[2, face])
    foot = data.xmat[body].reshape(3, 3)
    middle = data.geom_xpos[lowest] - model.geom_size[lowest, face] * up
    return foot.T @ up, foot.T @ (middle - data.xpos[body])
