"""Joints as MuJoCo actuators: a position servo as a `dcmotor`, an ideal joint as a `pid`.

Servo: ``nominal = (V, stall torque, no-load speed)``; ``kp`` = duty per rad at this P register
times V K/R; ``kd = K^2/R``, which cancels the back-EMF compensation of the dcmotor's controller and
leaves a plain voltage-driven motor behind a P law; ``Vmax = V x PWM limit``.
"""

from dataclasses import dataclass
from math import pi

import mujoco
import numpy as np

from windup.hal.command import JointCommand, shifted_goal
from windup.hal.joints import Array
from windup.hal.servos.servo_model import ServoModel
from windup.robots.description import RobotDescription

# Indices into a dcmotor's gainprm and a pid's biasprm (MuJoCo 4.0, XMLreference).
R, K, KP, KD, VMAX = 0, 1, 4, 6, 7
PID_KP, PID_KD = 1, 2
POSITION = 1  # mjCTRLSPEC bits of the actuators' inputs
VELOCITY = 2
FEED_FORWARD = 4


def add_actuators(
    spec: mujoco.MjSpec, robot: RobotDescription, delay: float, supply: float
) -> None:
    """Add an actuator to every joint of `spec`, in joint order.

    Args:
        spec: The robot's MJCF without actuators.
        robot: The robot.
        delay: Latency from a write until the actuator acts on it, s.
        supply: Supply voltage of the servos, V.
    """
    for index, name in enumerate(robot.joints.names):
        actuator = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        servo = robot.servos[index]
        if servo is None:
            joint = robot.joints.joints[index]
            inputs = POSITION | VELOCITY | FEED_FORWARD
            actuator.set_to_pid(kp=joint.stiffness, kv=joint.damping, ctrlspec=inputs)
            if np.isfinite(joint.torque):
                actuator.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
                actuator.forcerange = [-joint.torque, joint.torque]
        else:
            stiffness = robot.joints.joints[index].stiffness / servo.ratio**2
            register = round(servo.model.p_register(stiffness, robot.drive.supply))
            stiffness = servo.model.stiffness(register, supply)
            set_servo(actuator, servo.model, supply, stiffness, servo.ratio)
        if delay > 0.0:
            actuator.delay = delay
            actuator.nsample = max(1, round(delay / spec.option.timestep))


def set_servo(
    actuator: mujoco.MjsActuator,
    model: ServoModel,
    supply: float,
    stiffness: float,
    ratio: float = 1.0,
) -> None:
    """Make `actuator` a servo of type `model` at `supply` V and `stiffness` N m/rad.

    With a linkage that turns the servo `ratio` times per turn of the joint, the motor seen at the
    joint has `ratio` times the torque and 1/`ratio` of the speed, and its gains scale with
    `ratio` squared.
    """
    motor, gains = model.motor(supply), ratio**2
    actuator.set_to_dcmotor(
        motorconst=[0.0, 0.0],
        resistance=0.0,
        nominal=[supply, motor.stall_torque * ratio, motor.no_load_speed / ratio],
        controller=[
            gains * stiffness,
            0.0,
            gains * model.damping(supply),
            0.0,
            0.0,
            supply * model.pwm_limit,
        ],
        ctrlspec=POSITION,
    )


@dataclass
class ServoDrive:
    """Applies joint commands to the dcmotors of a model, as position servos would.

    Goals are rounded to encoder counts and stiffness to P registers. Feed-forward velocity and
    torque become a shifted goal; the damping is the motor's own.

    Attributes:
        model: The twin's model; gains are written into it.
        robot: The robot.
        supply: Supply voltage of the servos, V.
        factor: Ratio of these servos' stiffness to the data sheet's.
    """

    model: mujoco.MjModel
    robot: RobotDescription
    supply: float
    factor: float = 1.0

    def __post_init__(self) -> None:
        servos = [servo for servo in self.robot.servos if servo is not None]
        ratio = np.array([servo.ratio for servo in servos])
        per_rad = np.array([servo.model.counts_per_rev / (2.0 * pi) for servo in servos])
        self.counts, gains = per_rad * ratio, ratio**2
        self._unit = gains * [servo.model.stiffness(1.0, self.supply) for servo in servos]
        self._realised = np.empty((2, len(servos)))
        self._realised[1] = gains * [servo.model.damping(self.supply) for servo in servos]
        self._nominal = gains * [s.model.stiffness(1.0, self.robot.drive.supply) for s in servos]
        self._gains: bytes = b""
        self._nothing = bytes(2 * 8 * len(servos))
        self.sent_gains = 0

    def write(self, command: JointCommand, ctrl: Array) -> JointCommand:
        """Write goals into `ctrl` (n,) and return the command as the servos realise it."""
        block = command.block
        gains = block[3].tobytes()
        if gains != self._gains:
            self._send_gains(block[3])
            self._gains = gains
        # Comparing bytes takes a tenth of the time of `any`, and this runs on every tick.
        plain = block[1:3].tobytes() == self._nothing
        goal = block[0] if plain else shifted_goal(command)
        np.rint(goal * self.counts, out=ctrl)
        ctrl /= self.counts
        real = np.empty_like(block)
        real[0] = ctrl
        real[1:3] = 0.0
        real[3:] = self._realised
        return JointCommand(real)

    def _send_gains(self, stiffness: Array) -> None:
        """Round stiffness (n,) to whole P registers of the nominal supply and set kp.

        The register is computed for the nominal supply, as by a driver that does not measure the
        voltage; the resulting stiffness scales with the actual supply.
        """
        self._realised[0] = self.factor * np.rint(stiffness / self._nominal) * self._unit
        self.model.actuator_gainprm[:, KP] = self._realised[0]
        self.sent_gains += 1


@dataclass
class TorqueDrive:
    """Applies joint commands exactly: ideal joints that follow the torque law at every step.

    Attributes:
        model: The twin's model; gains are written into it.
        robot: The robot.
        factor: Ratio of these joints' stiffness to the commanded one.
    """

    model: mujoco.MjModel
    robot: RobotDescription
    factor: float = 1.0

    def __post_init__(self) -> None:
        self._gains: bytes = b""

    def write(self, command: JointCommand, ctrl: Array) -> JointCommand:
        """Write targets into `ctrl` (3 n,) and return `command` itself."""
        block = command.block
        gains = block[3:].tobytes()
        if gains != self._gains:
            self.model.actuator_biasprm[:, PID_KP] = -self.factor * block[3]
            self.model.actuator_biasprm[:, PID_KD] = -block[4]
            self._gains = gains
        ctrl.reshape(-1, 3)[:] = block[:3].T
        return command
