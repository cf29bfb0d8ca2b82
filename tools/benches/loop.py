"""Measures the duration of a tick, and the cost of the guarded twin beside bare physics."""

import gc
import time
from statistics import median
from typing import Any

import mujoco

from windup.hal.command import JointCommand
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.robot.robot import Robot

ROUNDS = 20


def measure_tick(name: str) -> dict[str, Any]:
    """Return the duration of a tick with guard and tracker: read, step, write, without physics."""
    with Robot.open(name) as robot:
        options = WalkOptions(open_loop=True)
        walker = build_walk(robot.description, options, None)
        gc.collect()
        robot.run(walker, 1.0)
        robot.twin.reset()
        robot.run(walker, 20.0)
        return {
            "rate_hz": 1.0 / robot.period,
            "ticks": robot.loop.ticks,
            "tick_p50_ms": robot.loop.tick_ms()["p50"],
            "tick_p99_ms": robot.loop.tick_ms()["p99"],
        }


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
