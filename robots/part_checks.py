"""Checks of the feet and the IMU of a robot.toml: bodies, sites and sensors of the MJCF."""

from collections.abc import Iterator

import mujoco

from windup.robots import mjcf
from windup.robots.imu import kind_mistakes
from windup.robots.mistake import Mistake, check_known, check_unique
from windup.robots.records import Foot, RobotFile

TOUCH = mujoco.mjtSensor.mjSENS_TOUCH
IMU_SENSORS = {
    "gyro": mujoco.mjtSensor.mjSENS_GYRO,
    "accelerometer": mujoco.mjtSensor.mjSENS_ACCELEROMETER,
    "orientation": mujoco.mjtSensor.mjSENS_FRAMEQUAT,
}


def foot_mistakes(robot: RobotFile, model: mujoco.MjModel) -> Iterator[Mistake]:
    """Yield unknown bodies, sites and sensors of feet, and two feet of the same side."""
    feet = [entry.foot() for entry in robot.foot]
    yield from check_unique("foot", "foot", [foot.name for foot in feet])
    yield from check_unique("foot", "sensor", [name for foot in feet for name in foot.sensors])
    if len(feet) == 2 and feet[0].side and feet[0].side == feet[1].side:
        one, other = (foot.name for foot in feet)
        yield "foot", f"{one!r} and {other!r} are both {feet[0].side}: give each its `side`"
    for foot, entry in zip(feet, robot.foot, strict=True):
        key = f"foot {foot.name!r}"
        bodies, sites = mjcf.names(model, "body"), mjcf.names(model, "site")
        yield from check_known(f"{key}: body", "body", foot.body, bodies)
        yield from check_known(f"{key}: site", "site", foot.site, sites)
        placed = foot.body in bodies and foot.site in sites
        if placed:
            yield from _sole(key, foot, model)
        if placed or entry.sensors is not None:  # otherwise a sensor could not be added
            for sensor in foot.sensors:
                yield from _sensor(f"{key}: sensors", sensor, TOUCH, model)


def imu_mistakes(robot: RobotFile, model: mujoco.MjModel) -> Iterator[Mistake]:
    """Yield an unknown site, an unknown kind or mounting, and unknown sensors of the IMU."""
    imu, sites = robot.imu, mjcf.names(model, "site")
    if imu is None:
        return
    yield from check_known("imu.site", "site", imu.site, sites)
    yield from kind_mistakes(imu, robot.bus)
    for key, kind in IMU_SENSORS.items() if imu.site in sites else ():
        if (name := getattr(imu, key)) is not None:
            yield from _sensor(f"imu.{key}", name, kind, model)


def _sole(key: str, foot: Foot, model: mujoco.MjModel) -> Iterator[Mistake]:
    """Yield a mistake if a foot's site is not on its body."""
    site = model.site(foot.site)
    if site.bodyid[0] != model.body(foot.body).id:
        there = model.body(site.bodyid[0]).name
        yield f"{key}: site", f"{foot.site!r} is on body {there!r}, not on {foot.body!r}"


def _sensor(
    key: str, name: str, kind: mujoco.mjtSensor, model: mujoco.MjModel
) -> Iterator[Mistake]:
    """Yield a mistake unless the MJCF has a sensor `name` of the given kind."""
    wanted = [other for other in mjcf.names(model, "sensor") if model.sensor(other).type[0] == kind]
    yield from check_known(key, f"{kind.name.removeprefix('mjSENS_').lower()} sensor", name, wanted)
