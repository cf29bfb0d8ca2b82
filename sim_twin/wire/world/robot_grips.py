"""Makes the grips with which hands turn the joints of a robot."""

from collections.abc import Mapping, Sequence
from functools import partial

from windup.robots import RobotDescription
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.shafts.shaft import InertiaShaft, Shaft
from windup.sim_twin.wire.shafts.twin_shaft import TwinPhysics, TwinShaft
from windup.sim_twin.wire.world.grips import grip_on_shaft
from windup.sim_twin.wire.world.hand import JointGrip

MountedServos = Mapping[str, Sequence[Device]]


def robot_grips(
    robot: RobotDescription,
    mounted: MountedServos,
    shafts: Sequence[Shaft],
    physics: TwinPhysics | None,
) -> dict[str, JointGrip]:
    """Return the grips of a robot, by joint.

    Args:
        robot: The robot.
        mounted: Its servos, by bus.
        shafts: Their shafts, in the order of the joints that have a servo.
        physics: The twin whose joints they are, or None if each servo has a separate shaft.
    """
    grips = {}
    joints = [(name, m) for name, m in zip(robot.joints.names, robot.servos, strict=True) if m]
    for (name, mount), shaft in zip(joints, shafts, strict=True):
        device = next(servo for servo in mounted[mount.bus] if servo.identifier == mount.id)
        if isinstance(shaft, InertiaShaft):
            grips[name] = grip_on_shaft(device, shaft, mount.sign * mount.ratio)
        elif isinstance(shaft, TwinShaft) and physics is not None:
            grips[name] = _on_twin(device, physics, shaft.joint)
    return grips


def _on_twin(device: Device, physics: TwinPhysics, joint: int) -> JointGrip:
    """Return a grip on a joint of a twin."""
    positions, at = physics.twin.data.qpos, int(physics.twin.indices.qpos[joint])
    return JointGrip(device, lambda: float(positions[at]), partial(physics.turn, joint))
