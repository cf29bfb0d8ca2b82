"""The robot's MJCF, completed to something that can be simulated."""

import mujoco

from robots.description import RobotDescription
from sim_twin.servo_motor import add_actuators


def build_model(
    robot: RobotDescription,
    *,
    delay: float | None = None,
    supply: float | None = None,
    bare: bool = False,
) -> mujoco.MjModel:
    """Return the robot's model with actuators.

    Args:
        robot: The robot.
        delay: From a write to the joint acting on it, s; the robot's own by default.
        supply: Voltage of the servos, V; the robot's own by default.
        bare: Leave out what a rollout, which ends with a fall, does not need.
    """
    spec = robot.spec()
    if bare:
        _strip(spec, robot)
    delay = robot.drive.command_delay if delay is None else delay
    add_actuators(spec, robot, delay, robot.drive.supply if supply is None else supply)
    # A twin that diverges says so; it does not quietly start again.
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    # One robot is one island: looking for more costs a few percent.
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_ISLAND)
    # MuJoCo 4.0's sparse Cholesky has a bug past our size; dense is faster here anyway.
    spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    return spec.compile()


def _strip(spec: mujoco.MjSpec, robot: RobotDescription) -> None:
    """Keep the geoms of feet and floor, and of the sensors touch and CoM velocity.

    Whatever else can touch the floor does so after the robot has fallen, and a rollout ends there.
    """
    feet = {foot.body for foot in robot.feet}
    for geom in list(spec.geoms):
        collides = geom.contype or geom.conaffinity
        if not collides or geom.parent.name not in {*feet, "world"}:
            spec.delete(geom)
    kept = {*robot.contacts.names, "com_velocity"}
    for sensor in list(spec.sensors):
        if sensor.name not in kept:
            spec.delete(sensor)
