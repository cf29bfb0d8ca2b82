"""The watches of a run once more, over the ticks of its telemetry: same levels, same words."""

from collections.abc import Iterator

import numpy as np

from windup.hal.command import FIELDS, JointCommand
from windup.hal.guard import HealthLevels, HealthWatch
from windup.hal.guard.finding import Finding
from windup.hal.guard.imu_watch import ImuWatch
from windup.hal.joints import Joints
from windup.hal.observation import ImuState, JointState, Observation
from windup.hal.telemetry.layout import Header
from windup.hal.telemetry.ring import Ticks

JOINTS = ("position", "velocity", "torque", "voltage", "temperature", "age", "health_age")


def findings(
    header: Header, ticks: Ticks, joints: Joints, levels: HealthLevels
) -> Iterator[Finding]:
    """Yield what the watches found in the ticks: one a kind, a stop instead of its warning."""
    health, imu = HealthWatch(joints, levels), ImuWatch()
    stops: dict[str, Finding] = {}
    watched = bool(np.isfinite(levels.torque).any())
    for tick in ticks:
        observation = observed(tick)
        if watched:
            found = health.update(observation, told(tick))
            if found is not None:
                stops.setdefault(found.saying.name, found)
        if header.estimated:
            imu.update(observation)
    for warning in (*health.warnings, *imu.warnings):
        yield stops.get(warning.saying.name, warning)


def observed(tick: np.void) -> Observation:
    """Return what was observed in a tick, without its base."""
    joints = JointState(*(tick[name] for name in JOINTS))
    imu = None
    if np.isfinite(tick["imu_age"]):
        imu = ImuState(
            None,
            tick["imu_angular_velocity"],
            tick["imu_acceleration"],
            float(tick["imu_age"]),
        )
    return Observation(float(tick["time"]), joints, imu, tick["contacts"], None)


def told(tick: np.void) -> JointCommand:
    """Return what the joints were told in a tick, as far as telemetry keeps it."""
    block = np.zeros((len(FIELDS), len(tick["command"])))
    block[FIELDS.index("position")] = tick["command"]
    block[FIELDS.index("stiffness")] = tick["stiffness"]
    return JointCommand(block)
