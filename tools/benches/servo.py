"""Compares the twin's servo on a test stand with its data sheet."""

from typing import Any

import mujoco
import numpy as np

from windup.hal.servos.servo_model import ServoModel
from windup.robots import load_robot
from windup.sim_twin.servo.servo_motor import set_servo

STEP = 0.001
INERTIA = 0.01  # of the stand's lever, kg m2
LOAD = 0.4  # share of the stall torque, for the static deflection


def measure_servos(name: str) -> dict[str, Any]:
    """Return stall torque, no-load speed and deflection of each servo type of a robot.

    Every value is the ratio of the twin's result to that of the data sheet (or the P law).
    """
    servos = {servo.model.name: servo.model for servo in load_robot(name).servos if servo}
    result = {}
    for model in servos.values():
        for row in model.rows:
            stand = TestStand(model, row.voltage)
            result[f"{model.name} at {row.voltage:g} V"] = {
                "stall_torque": round(stand.stall_torque() / row.stall_torque, 4),
                "no_load_speed": round(stand.no_load_speed() / row.no_load_speed, 4),
                "deflection": round(stand.deflection(), 4),
            }
    return result


class TestStand:
    """One servo on a bench, with a lever that can be blocked, freed or loaded.

    Args:
        model: The servo.
        voltage: Its supply, V.
    """

    def __init__(self, model: ServoModel, voltage: float) -> None:
        spec = mujoco.MjSpec()
        spec.option.timestep = STEP
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        lever = spec.worldbody.add_body(name="lever", mass=1.0, inertia=[INERTIA] * 3)
        lever.explicitinertial = True
        lever.add_joint(
            name="shaft", axis=[0, 0, 1], armature=model.armature, frictionloss=model.friction_loss
        )
        actuator = spec.add_actuator(
            name="servo", target="shaft", trntype=mujoco.mjtTrn.mjTRN_JOINT
        )
        self.stiffness = model.stiffness(model.p_default, voltage)
        self.load = LOAD * model.motor(voltage).stall_torque
        set_servo(actuator, model, voltage, self.stiffness)
        self.model = spec.compile()

    def stall_torque(self) -> float:
        """Return the torque at the blocked shaft with a distant goal, N m."""
        data = mujoco.MjData(self.model)
        data.ctrl[0] = np.pi
        mujoco.mj_forward(self.model, data)
        return float(data.actuator_force[0])

    def no_load_speed(self) -> float:
        """Return the speed of the free shaft with a goal that stays ahead, rad/s."""
        data = mujoco.MjData(self.model)
        for _ in range(round(2.0 / STEP)):
            data.ctrl[0] = data.qpos[0] + np.pi
            mujoco.mj_step(self.model, data)
        return float(data.qvel[0])

    def deflection(self) -> float:
        """Return the static deflection under a load relative to that of the P law.

        Coulomb friction stops the shaft on either side of equilibrium; the mean of approaching it
        from above and from below is what a bench shows.
        """
        rest = []
        for start in (0.0, 2.0 * self.load / self.stiffness):
            data = mujoco.MjData(self.model)
            data.qpos[0] = start
            data.qfrc_applied[0] = self.load
            for _ in range(round(3.0 / STEP)):
                mujoco.mj_step(self.model, data)
            rest.append(data.qpos[0])
        return float(np.mean(rest)) * self.stiffness / self.load
