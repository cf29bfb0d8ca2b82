"""Checks of the poses of a robot.toml, and of the keys that refer to poses."""

from collections.abc import Iterator, Mapping
from math import isnan

from windup.robots.mistake import SLACK, Mistake, check_known
from windup.robots.records import JointEntry, RobotFile


def pose_mistakes(robot: RobotFile) -> Iterator[Mistake]:
    """Yield unknown joints in poses, and angles outside the joint limits."""
    joints = {joint.name: joint for joint in robot.joint}
    for pose, angles in robot.poses.items():
        for name, angle in angles.items():
            yield from check_known(f"poses.{pose}", "joint", name, joints)
            if name in joints:
                yield from _outside(f"poses.{pose}.{name}", angle, joints[name])
        yield from _unnamed(f"poses.{pose}", angles, joints)


def stop_mistakes(robot: RobotFile) -> Iterator[Mistake]:
    """Yield mistakes in stance, crouch, stop and fall."""
    yield from check_known("stance", "pose", robot.stance, robot.poses)
    if robot.crouch is not None:
        yield from check_known("crouch", "pose", robot.crouch, robot.poses)
    elif robot.stop == "crouch":
        yield "stop", '"crouch" needs the key crouch: the name of a pose'
    fall = robot.fall
    if fall is None:
        return
    if fall.way and fall.reach is None:
        yield "fall.way", "needs fall.reach: how far outside its soles it can step, m"
    if fall.way and not robot.foot:
        yield "fall.way", "needs a [[foot]]: falls are predicted from the positions of the soles"
    for way in fall.way:
        yield from check_known("fall.way.pose", "pose", way.pose, robot.poses)


def _outside(key: str, angle: float, joint: JointEntry) -> Iterator[Mistake]:
    if angle < joint.lower - SLACK or angle > joint.upper + SLACK:
        yield key, f"{angle:g} rad is outside {joint.lower:g} to {joint.upper:g} rad"


def _unnamed(
    key: str, angles: Mapping[str, float], joints: Mapping[str, JointEntry]
) -> Iterator[Mistake]:
    """Yield the joints that a pose omits although 0 is outside their limits."""
    for name, joint in joints.items():
        around_zero = joint.lower <= 0.0 <= joint.upper or isnan(joint.lower + joint.upper)
        if name not in angles and not around_zero:
            yield key, f"names no {name!r}, and 0 is outside its limits"
