"""A biped of one joint a leg, and what its sensors say while it moves as one likes."""

from dataclasses import dataclass, field

import mujoco
import numpy as np

from windup.control.estimation.estimator import BaseEstimator
from windup.control.estimation.foot_load import FootLoad
from windup.control.kinematics.robot_state import RobotState
from windup.control.kinematics.soles import Soles
from windup.hal.contacts import ContactSensors
from windup.hal.joints import Array
from windup.hal.observation import BaseState, ImuState, JointState, Observation

DT = 0.004
GRAVITY = 9.81
LEG = """
<body name="{0}" pos="0 {1} -0.2">
  <joint name="{0}" axis="0 1 0"/>
  <inertial mass="0.1" pos="0 0 0" diaginertia="1e-4 1e-4 1e-4"/>
  <geom name="{0}" type="box" size="0.06 0.03 0.005" pos="0.01 0 -0.045"/>
  <site name="{0}_toe" pos="0.07 0 -0.05"/>
  <site name="{0}_heel" pos="-0.05 0 -0.05"/>
</body>"""
SENSORS = "".join(
    f'<touch name="{name}" site="{name}"/>'
    for name in ("left_toe", "left_heel", "right_toe", "right_heel")
)
MJCF = f"""
<mujoco>
  <worldbody>
    <body name="base" pos="0 0 0.25">
      <freejoint/>
      <inertial mass="1" pos="0 0 0" diaginertia="1e-2 1e-2 1e-2"/>
      {LEG.format("left", 0.05)}{LEG.format("right", -0.05)}
    </body>
  </worldbody>
  <sensor>{SENSORS}</sensor>
</mujoco>"""
CONTACTS = ContactSensors(
    ("left_toe", "left_heel", "right_toe", "right_heel"),
    {"left": ("left_toe", "left_heel"), "right": ("right_toe", "right_heel")},
)
BOTH_FEET = np.full(4, 3.0)
AIR = np.zeros(4)


def model() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(MJCF)


def soles() -> Soles:
    return Soles(model(), ["left", "right"], CONTACTS)


def robot_state() -> RobotState:
    feet = ["left", "right"]
    return RobotState(
        model(), "base", "base", ["left_toe", "right_toe"], feet=feet, contacts=CONTACTS
    )


def estimator(*, switches: bool = True, **options: object) -> BaseEstimator:
    load = FootLoad(soles(), CONTACTS, 1.2 * GRAVITY, sensed=switches)
    return BaseEstimator(load, np.zeros(3), **options)  # type: ignore[arg-type]


def turned(pitch: float) -> Array:
    """Orientation (4,) of a base that leans forward by `pitch` rad."""
    return np.array([np.cos(pitch / 2.0), 0.0, np.sin(pitch / 2.0), 0.0])


def observed(
    time: float,
    *,
    pitch: float = 0.0,
    pitch_rate: float = 0.0,
    yaw_rate: float = 0.0,
    acceleration: Array | None = None,
    bias: Array | None = None,
    contacts: Array = BOTH_FEET,
    leg: Array | None = None,
    leg_rate: Array | None = None,
    imu_age: float = 0.0,
    joint_age: Array | None = None,
) -> Observation:
    """What a base says that leans by `pitch` and accelerates in the world as given."""
    force = np.array([0.0, 0.0, GRAVITY]) + (0.0 if acceleration is None else acceleration)
    c, s = np.cos(pitch), np.sin(pitch)
    felt = np.array([c * force[0] - s * force[2], force[1], s * force[0] + c * force[2]])
    gyro = np.array([0.0, pitch_rate, yaw_rate]) + (0.0 if bias is None else bias)
    zero = np.zeros(2)
    joints = JointState(
        zero if leg is None else leg,
        zero if leg_rate is None else leg_rate,
        zero,
        zero,
        zero,
        zero if joint_age is None else joint_age,
    )
    return Observation(time, joints, ImuState(None, gyro, felt, imu_age), contacts, None)


@dataclass
class Run:
    """Feeds an estimator tick by tick."""

    estimator: BaseEstimator
    time: float = 0.0
    bases: list[BaseState] = field(default_factory=list)

    def tick(self, **motion: object) -> BaseState:
        seen = self.estimator.update(observed(self.time, **motion), DT)  # type: ignore[arg-type]
        assert seen.base is not None
        self.bases.append(seen.base)
        self.time += DT
        return seen.base

    def hold(self, seconds: float, **motion: object) -> BaseState:
        for _ in range(round(seconds / DT)):
            base = self.tick(**motion)
        return base


def lean(base: BaseState) -> float:
    """Forward lean of an estimated base, rad."""
    w, x, y, z = base.orientation
    return float(np.arcsin(2.0 * (w * y - x * z)))
