"""A robot in its stance pose, with the base pose of the MJCF."""

import mujoco

from windup.robots.couplings import satisfy_couplings
from windup.robots.description import RobotDescription


def in_stance(robot: RobotDescription) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return the model, and data in the stance with kinematics and centres of mass computed."""
    model = robot.model
    data = mujoco.MjData(model)
    for name, angle in zip(robot.joints.names, robot.stance, strict=True):
        data.joint(name).qpos[0] = angle
    satisfy_couplings(model, data.qpos, robot.joints.names)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    return model, data
