"""Completion of an MJCF with sensors (IMU, feet, CoM velocity) and couplings that it lacks."""

from collections.abc import Iterable

import mujoco
import numpy as np

from windup.robots.couplings import add_couplings
from windup.robots.records import ACCELEROMETER, GYRO, CouplingEntry, Foot, Imu, RobotFile

COM_VELOCITY = "com_velocity"
SITE = mujoco.mjtObj.mjOBJ_SITE
IMU_KINDS = {
    GYRO: mujoco.mjtSensor.mjSENS_GYRO,
    ACCELEROMETER: mujoco.mjtSensor.mjSENS_ACCELEROMETER,
}
REACH = 0.01
"""Margin of a touch sensor's zone around the geoms of its foot, m."""


def complete_for(robot: RobotFile, spec: mujoco.MjSpec) -> None:
    """Add to an MJCF what it lacks of what a `robot.toml` requires."""
    feet = [entry.foot() for entry in robot.foot]
    complete(spec, robot.base, robot.imu, feet, robot.coupling)


def complete(
    spec: mujoco.MjSpec,
    base: str,
    imu: Imu | None,
    feet: Iterable[Foot],
    couplings: Iterable[CouplingEntry] = (),
) -> None:
    """Add couplings, and missing sensors of default names; unknown names are left to the checks.

    Args:
        spec: The robot's MJCF, changed in place.
        base: Name of its base; a sensor for the velocity of the CoM is added.
        imu: Its IMU: a gyroscope and an accelerometer are added if they have default names.
        feet: Its feet: a touch sensor of the whole foot is added if it has the default name.
        couplings: Couplings of robot.toml.
    """
    add_couplings(spec, couplings)
    there = {sensor.name for sensor in spec.sensors}
    if imu is not None and spec.site(imu.site) is not None:
        for name, kind in IMU_KINDS.items():
            if name in (imu.gyro, imu.accelerometer) and name not in there:
                spec.add_sensor(name=name, type=kind, objtype=SITE, objname=imu.site)
    if COM_VELOCITY not in there and spec.body(base) is not None:
        kind, body = mujoco.mjtSensor.mjSENS_SUBTREELINVEL, mujoco.mjtObj.mjOBJ_BODY
        spec.add_sensor(name=COM_VELOCITY, type=kind, objtype=body, objname=base)
    for foot in feet:
        if foot.sensors == (name := f"{foot.name}_touch",) and name not in there:
            _add_touch(spec, foot, name)


def _add_touch(spec: mujoco.MjSpec, foot: Foot, name: str) -> None:
    """Add a touch sensor of a whole foot; its zone is a ball around the sole's centre."""
    body, sole = spec.body(foot.body), spec.site(foot.site)
    if body is None or sole is None or sole.parent.name != foot.body:
        return
    model = spec.compile()
    geoms = model.geom_bodyid == model.body(foot.body).id
    away = np.linalg.norm(model.geom_pos[geoms] - model.site(foot.site).pos, axis=1)
    radius = REACH + float((away + model.geom_rbound[geoms]).max(initial=0.0))
    body.add_site(name=name, pos=sole.pos, type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[radius] * 3)
    kind = mujoco.mjtSensor.mjSENS_TOUCH
    spec.add_sensor(name=name, type=kind, objtype=SITE, objname=name)
