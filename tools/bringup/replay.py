"""Repeats the watches of a run on the ticks of its telemetry, with the same levels and texts."""

from collections.abc import Iterator

import numpy as np

from windup.hal.command import JointCommand
from windup.hal.guard import HealthLevels, HealthWatch
from windup.hal.guard.finding import Finding
from windup.hal.guard.imu_watch import ImuWatch
from windup.hal.joints import Joints
from windup.hal.telemetry.header import Header
from windup.hal.telemetry.observed import observation_of
from windup.hal.telemetry.reader import Ticks


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
            found = health.update(observation, JointCommand(tick["applied"]))
            if found is not None:
                stops.setdefault(found.text.name, found)
        if header.estimated:
            imu.update(observation)
    for warning in (*health.warnings, *imu.warnings):
        yield stops.get(warning.text.name, warning)
