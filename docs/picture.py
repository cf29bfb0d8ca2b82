"""Draws the picture of the README: OP3 in the middle of a step.

Run it with `MUJOCO_GL=egl python docs/picture.py`; no display is needed.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import mujoco
import numpy as np

from windup import Observation, Robot

WHEN = 2.14
"""Into the walk, s."""
SIZE = (900, 560)


def pose_of_a_step() -> np.ndarray:
    """Walk, and return the state (nq,) of the twin when it is in the middle of a step."""
    poses: list[np.ndarray] = []
    with Robot.open("op3") as robot:

        def keep(observation: Observation) -> None:
            """Take the pose once it is time."""
            if not poses and robot.twin.time >= WHEN:
                poses.append(robot.twin.data.qpos.copy())

        robot.watch.append(keep)
        robot.walk(speed=0.3, steps=16)
    return poses[0]


def main() -> None:
    """Draw it."""
    pose = pose_of_a_step()
    with Robot.open("op3") as robot:
        model = robot.description.spec().compile()
    model.vis.global_.offwidth, model.vis.global_.offheight = SIZE
    data = mujoco.MjData(model)
    data.qpos[:] = pose
    mujoco.mj_forward(model, data)
    camera = mujoco.MjvCamera()
    camera.lookat[:] = (pose[0], pose[1], 0.22)
    camera.distance, camera.azimuth, camera.elevation = 0.95, 145, -12
    options = mujoco.MjvOption()
    options.geomgroup[3] = 0  # what collides
    options.sitegroup[4] = 0
    with mujoco.Renderer(model, height=SIZE[1], width=SIZE[0]) as renderer:
        renderer.update_scene(data, camera, options)
        plt.imsave(Path(__file__).with_name("op3.png"), renderer.render())


if __name__ == "__main__":
    main()
