"""Repeats the watches of a run on the ticks of its telemetry, with the same levels and texts."""

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
    """Yield the findings in the ticks: one per kind, a stop in place of its warning."""
    health, imu = HealthWatch(joints, levels), ImuWatch()
    stops: dict[str, Finding] = {}
    watched = bool(np.isfinite(levels.torque).any())
    for tick in ticks:
        observation = observation_of(tick)
        if watched:
            found = health.update(observation, command_of(tick))
            if found is not None:
                stops.setdefault(found.text.name, found)
        if header.estimated:
            imu.update(observation)
    for warning in (*health.warnings, *imu.warnings):
        yield stops.get(warning.text.name, warning)


def observation_of(tick: np.void) -> Observation:
    """Return the observation of a tick, without the base state."""
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


def command_of(tick: np.void) -> JointCommand:
    """Return the command of a tick, as far as telemetry contains it."""
    block = np.zeros((len(FIELDS), len(tick["command"])))
    block[FIELDS.index("position")] = tick["command"]
    block[FIELDS.index("stiffness")] = tick["stiffness"]
    return JointCommand(block)
