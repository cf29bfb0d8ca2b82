"""Deviations of a simulated robot from its files: gains, friction, delay, mass and supply."""

from dataclasses import dataclass

import mujoco
import numpy as np

from windup.robots import RobotDescription

XM430 = 4.1
"""Stall torque of the servo for which the friction range of `Plant.random` holds, N m."""


@dataclass(frozen=True)
class Plant:
    """Deviations that a twin has but the rollouts' model lacks; None means as in the files.

    Attributes:
        stiffness: Factor on the stiffness of all joints.
        friction_loss: Coulomb friction of every joint, N m.
        delay: Latency from a write until the joint acts on it, s.
        floor: Friction coefficient between feet and floor.
        mass: Factor on all masses and inertias.
        supply: Supply voltage of the servos, V.
    """

    stiffness: float = 1.0
    friction_loss: float | None = None
    delay: float | None = None
    floor: float | None = None
    mass: float = 1.0
    supply: float | None = None

    @classmethod
    def random(cls, seed: int, robot: RobotDescription) -> "Plant":
        """Return a random plant that an untuned walk should survive.

        kp -20..+20 %, friction loss 0-0.3 N m (less with servos weaker than 4.1 N m), delay
        4-24 ms in whole physics steps, floor 0.5-1.0, mass -10..+10 %, supply -12.5..+5 %
        (10.5-12.6 V of 12).
        """
        weak = min(float(robot.joints.torque.min()) / XM430, 1.0)
        timestep, nominal = robot.timestep, robot.drive.supply / 12.0
        draw = np.random.default_rng([7, seed]).uniform
        return cls(
            stiffness=draw(0.8, 1.2),
            friction_loss=draw(0.0, 0.3) * weak,
            delay=round(draw(0.004, 0.024) / timestep) * timestep,
            floor=draw(0.5, 1.0),
            mass=draw(0.9, 1.1),
            supply=draw(10.5, 12.6) * nominal,
        )

    def apply_to(self, spec: mujoco.MjSpec) -> None:
        """Apply this plant's friction and mass factors to `spec`."""
        for body in spec.bodies:
            body.mass *= self.mass
            body.inertia *= self.mass
            body.fullinertia *= self.mass
        for joint in spec.joints:
            if joint.type == mujoco.mjtJoint.mjJNT_HINGE and self.friction_loss is not None:
                joint.frictionloss = self.friction_loss
        for geom in spec.geoms:
            if self.floor is not None and (geom.contype or geom.conaffinity):
                geom.friction[0] = self.floor
