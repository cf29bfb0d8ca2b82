"""Measures the cost of the guarded twin beside bare physics."""

import time
from statistics import median
from typing import Any

import mujoco

from windup.hal.command import JointCommand
from windup.tools.robot.robot import Robot

ROUNDS = 20


def measure_twin(name: str) -> dict[str, Any]:
    """Return the speed of the guarded twin against bare `mj_step`, for two command periods."""
    result: dict[str, Any] = {}
    for period in (0.008, 0.004):
        ratios = [_twin_ratio(name, period) for _ in range(ROUNDS)]
        result[f"ratio_at_{1e3 * period:g}_ms"] = round(median(ratios), 3)
    return result


def _twin_ratio(name: str, period: float, seconds: float = 2.0) -> float:
    """Return bare time over guarded time for the same simulated seconds of standing."""
    with Robot.open(name) as robot:
        twin, backend = robot.twin, robot.backend
        steps = round(period / twin.timestep)
        command = JointCommand.hold(robot.description.joints, robot.description.stance)
        twin.reset()
        start = twin.save()
        ticks = round(seconds / period)
        began = time.perf_counter()
        for _ in range(ticks):
            mujoco.mj_step(twin.model, twin.data, steps)
        bare = time.perf_counter() - began
        twin.restore(start)
        clock = backend.clock
        origin = clock.now()
        began = time.perf_counter()
        for tick in range(ticks):
            backend.read()
            backend.write(command)
            clock.wait_until(origin + (tick + 1) * period)
        return bare / (time.perf_counter() - began)
