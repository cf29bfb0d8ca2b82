"""A robot as it stands in its stance, its base where the MJCF has it."""

import mujoco

from windup.robots.couplings import bring_in_step
from windup.robots.description import RobotDescription


def in_stance(robot: RobotDescription) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return the model and a state in which poses of bodies and centres of mass are known."""
    model = robot.spec().compile()
    data = mujoco.MjData(model)
    for name, angle in zip(robot.joints.names, robot.stance, strict=True):
        data.joint(name).qpos[0] = angle
    bring_in_step(model, data.qpos, robot.joints.names)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    return model, data
