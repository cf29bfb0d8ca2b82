"""Measures the duration of a tick of the loop: read, estimate, step, write, without physics.

The 99th percentile of each behaviour is also given as a multiple of one bare `mj_step` of OP3,
measured in the same run: the multiple says how the code is, and the milliseconds how fast the
computer is. Garbage collection is off, as in a loop on wall time (see `hal.clock.punctual`).
"""

import gc
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import radians
from statistics import median
from typing import Any, Final

import mujoco

from windup.control.loop import LoopReport
from windup.robots import RobotDescription, load_robot
from windup.sim_twin.twin import Twin
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.stepping import STEPPING, build_stepper, find_stepping, stepping_stance
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.robot.robot import Robot
from windup.tools.robot.stack import State

BARE: Final = "op3"
STEPS: Final = 2000
WALK_SECONDS: Final = 20.0
DIRECTIONS: Final = (30.0, 200.0, 330.0)
"""Directions of the pushes against which the robots step, one a run, degrees."""
STEP_SECONDS: Final = 4.0
IMPULSES: Final = {"op3": 1.9, "human": 40.0}
SPEED: Final = 0.5
"""Impulses of these pushes, N s; for another robot its mass times this speed, m/s."""
TARGETS: Final = {"op3_walking": 9.0, "op3_stepping": 12.0, "human_stepping": 19.0}
"""Largest 99th percentile of the tick, in bare steps of OP3, of the behaviours without --robot."""


@dataclass
class TickTimes:
    """Measures behaviours, and the bare step before and after each of them.

    Attributes:
        result: What has been measured so far.
    """

    result: dict[str, Any] = field(default_factory=dict)
    _bare: list[float] = field(default_factory=list)
    _p99: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._twin = Twin(load_robot(BARE))
        self._time_bare()

    def measure(self, name: str, run: Callable[[], LoopReport]) -> LoopReport:
        """Measure the ticks of a behaviour, which `run` runs."""
        with _without_collection():
            loop = run()
        self._time_bare()
        times = loop.tick_ms()
        self._p99[name] = times["p99"]
        self.result |= {f"{name}_{key}_ms": value for key, value in times.items()}
        return loop

    def conclude(self) -> dict[str, Any]:
        """Return the result, with the multiples of the bare step (its median)."""
        bare = 1e3 * median(self._bare)
        multiples = {f"{name}_p99_steps": round(p99 / bare, 2) for name, p99 in self._p99.items()}
        return self.result | {"bare_step_ms": bare} | multiples

    def _time_bare(self) -> None:
        """Time steps of OP3's physics, standing on the floor."""
        twin = self._twin
        twin.reset()
        for _ in range(STEPS):
            began = time.perf_counter()
            mujoco.mj_step(twin.model, twin.data)
            self._bare.append(time.perf_counter() - began)


def measure_tick(name: str, *, targets: bool = False) -> dict[str, Any]:
    """Return the ticks of a walk, and of steps under pushes where the robot steps.

    Args:
        name: The robot. With servos it steps on the estimated state, and with torque joints by
            whole-body control on the true state.
        targets: Also measure the human's steps, and compare with `TARGETS`.

    Raises:
        WindupError: The robot cannot be opened, or cannot walk.
    """
    times = TickTimes()
    with Robot.open(name) as robot:
        loop = times.measure(f"{robot.description.name}_walking", lambda: _walk(robot))
        walk = {f"tick_{key}_ms": value for key, value in loop.tick_ms().items()}
        first = {"rate_hz": 1.0 / robot.period, "ticks": loop.ticks, **walk}
    for stepping in (name, "human") if targets else (name,):
        _measure_stepping(stepping, times)
    result = first | times.conclude()
    if targets:
        result["met"] = all(result[f"{key}_p99_steps"] <= most for key, most in TARGETS.items())
    return result


def _walk(robot: Robot) -> LoopReport:
    """Walk with kept step models, and return how that went, without the time of rollouts."""
    walker = build_walk(robot.description, WalkOptions(model="library"), robot.predictor)
    robot.start_at(walker.gait.file.start)
    return robot.run(walker, WALK_SECONDS, rollouts=robot.predictor.stopwatch)


def _measure_stepping(name: str, times: TickTimes) -> None:
    """Measure steps under pushes, if the robot has a stepping.toml."""
    description = load_robot(name)
    if not (description.folder / STEPPING).is_file():
        return
    times.measure(f"{description.name}_stepping", lambda: _step(name, description))


def _step(name: str, description: RobotDescription) -> LoopReport:
    """Step against pushes from several sides, and return the ticks of all runs."""
    stepping, whole = find_stepping(description), LoopReport()
    state: State = "true" if description.drive.kind == "torque" else "estimated"
    stance = stepping_stance(description)
    for direction in DIRECTIONS:
        with Robot.open(name, state=state, rate=stepping.rate) as robot:
            mass = float(robot.twin.model.body_mass.sum())
            impulse = IMPULSES.get(description.name, SPEED * mass)
            robot.start_in(stance)
            robot.push(impulse, radians(direction), delay=0.5)
            delay = robot.stack.delay
            stepper = build_stepper(description, stepping.way, stance, delay=delay)
            whole.tick += robot.run(stepper, STEP_SECONDS).tick
    return whole


@contextmanager
def _without_collection() -> Iterator[None]:
    """Switch garbage collection off, as it is in a loop on wall time."""
    gc.collect()
    gc.freeze()
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
        gc.unfreeze()
