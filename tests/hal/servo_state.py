"""Made-up observations of three joints with servos."""

from collections.abc import Sequence

import numpy as np

from windup.hal.command import JointCommand
from windup.hal.families import servo_model
from windup.hal.guard import HealthLevels, HealthWatch
from windup.hal.joints import Joint, Joints
from windup.hal.observation import JointState, Observation
from windup.hal.servos.servo_model import ServoMount

NAMES = ("hip", "knee", "ankle")
KNEE = 1
MODEL = servo_model("XM430-W350")
STALL = MODEL.motor(12.0).stall_torque
STIFFNESS = 20.0
JOINTS = Joints(tuple(Joint(name, -2.0, 2.0, STIFFNESS, 1.0, STALL, 5.0) for name in NAMES))
MOUNTS = [ServoMount(MODEL, "leg", id, 1, 2048, 1.0) for id in range(3)]
LEVELS = HealthLevels.of(MOUNTS, 12.0)
DT = 1.0 / 128.0  # no rounding in sums of it
WELL = {"position": 0.0, "velocity": 0.0, "torque": 0.0, "voltage": 12.0, "temperature": 30.0}


def watch(look: str = "") -> HealthWatch:
    return HealthWatch(JOINTS, LEVELS, look)


def seen(time: float, **knee: float) -> Observation:
    """Return an observation of joints that are well but for the knee, or for their supply."""
    columns = {name: np.full(3, value) for name, value in WELL.items()}
    for name, value in knee.items():
        columns[name][slice(None) if name == "voltage" else KNEE] = value
    return Observation(time, JointState(**columns, age=np.zeros(3)), None, np.zeros(0), None)


def goal(knee: float) -> JointCommand:
    return JointCommand.hold(JOINTS, np.array([0.0, knee, 0.0]))


def stop_of(
    judge: HealthWatch, observations: Sequence[Observation], command: JointCommand | None = None
) -> tuple[float, str] | None:
    """Return when the watch wants to stop, and why, or None."""
    for observation in observations:
        if (unwell := judge.update(observation, command)) is not None:
            return observation.time, str(judge.error(unwell))
    return None


def stretch(seconds: float, begin: float = 0.0, **knee: float) -> list[Observation]:
    """Return observations of `seconds` s in which the knee stays as it is."""
    return [seen(begin + k * DT, **knee) for k in range(round(seconds / DT))]
