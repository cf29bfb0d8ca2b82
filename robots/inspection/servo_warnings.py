"""Warnings about joint torques and velocities that exceed those of the servos."""

from collections.abc import Iterator

from windup.robots.description import RobotDescription

SLACK = 1.02
"""Factor by which a joint may exceed its rounded data sheet."""


def servo_warnings(robot: RobotDescription) -> Iterator[str]:
    """Yield a warning for each joint whose torque or velocity exceeds that of its servo."""
    supply = robot.drive.supply
    for joint, servo in zip(robot.joints.joints, robot.servos, strict=True):
        if servo is None:
            continue
        motor = servo.model.motor(supply)
        strong, fast = motor.stall_torque * servo.ratio, motor.no_load_speed / servo.ratio
        able = f"{servo.model.name} has at {supply:g} V and ratio {servo.ratio:g}"
        if joint.torque > strong * SLACK:
            yield (
                f"joint {joint.name!r}: torque {joint.torque:g} N m is more than the "
                f"{strong:.3g} N m at stall that its {able}: omit it"
            )
        if joint.velocity > fast * SLACK:
            yield (
                f"joint {joint.name!r}: velocity {joint.velocity:g} rad/s is more than the "
                f"{fast:.3g} rad/s without load that its {able}: omit it"
            )
