"""The observation of a recorded tick, as the controller got it."""

from math import isnan

import numpy as np

from windup.hal.observation import BaseState, ImuState, JointState, Observation

JOINTS = ("position", "velocity", "torque", "voltage", "temperature", "age", "health_age")


def observation_of(tick: np.void) -> Observation:
    """Return the observation of a tick; its arrays have the values that were recorded, bit by bit.

    An IMU that had no age, an orientation and a base state that were NaN were missing.
    """
    joints = JointState(*(tick[name] for name in JOINTS))
    return Observation(float(tick["time"]), joints, _imu(tick), tick["contacts"], _base(tick))


def _imu(tick: np.void) -> ImuState | None:
    if isnan(tick["imu_age"]):
        return None
    orientation = tick["imu_orientation"]
    return ImuState(
        None if np.isnan(orientation).all() else orientation,
        tick["imu_angular_velocity"],
        tick["imu_acceleration"],
        float(tick["imu_age"]),
    )


def _base(tick: np.void) -> BaseState | None:
    if np.isnan(tick["base_position"]).all():
        return None
    return BaseState(
        tick["base_position"],
        tick["base_orientation"],
        tick["base_linear_velocity"],
        tick["base_angular_velocity"],
        float(tick["base_confidence"]),
    )
