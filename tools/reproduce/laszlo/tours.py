"""Walks by the product's own control, for what the thesis shows and its control alone does not."""

from dataclasses import replace
from typing import Any

import numpy as np

from windup.control.limit_cycle.balancer import Balancer
from windup.hal.errors import DivergedError
from windup.hal.observation import Observation
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.measures.gauges import Gauges
from windup.tools.measures.walk_end import WalkEnd
from windup.tools.reproduce.laszlo.recorder import Recorder
from windup.tools.reproduce.study.figure import Job, Result
from windup.tools.robot.robot import Robot

NOISE = 0.2  # degrees
BEND = "spine"  # the joint that bends a human over; of the others the first one
KEPT = ("gait", "speed", "torso_servo", "path")


def tour(**options: Any) -> Job:
    """Return a walk; options are those of `run_tour`."""
    base: dict[str, Any] = {"robot": "human", "steps": 60, "seed": 0}
    return Job("tour", base | options)


def run_tour(
    *,
    robot: str,
    steps: int,
    seed: int,
    style: list[str] | None = None,
    to: list[float] | None = None,
    **options: Any,
) -> Result:
    """Walk as `windup walk` would and keep every step and a trace of the motion.

    Args:
        robot: Its name.
        steps: How many, unless a goal is reached before.
        seed: Of the noise on the start pose.
        style: As `--style` has it.
        to: Point to walk to, m.
        options: Further ones of `WalkOptions`; see `KEPT`.
    """
    assert set(options) <= set(KEPT), options
    asked = WalkOptions(style=tuple(style or ()), **options)
    if to is not None:
        asked = replace(asked, to=(to[0], to[1]))
    with Robot.open(robot, seed=seed, noise=NOISE) as machine:
        walker = build_walk(machine.description, asked, machine.predictor)
        seen = _Seen(machine, walker)
        machine.watch.append(seen.add)
        machine.start_at(walker.gait.file.start)
        try:
            machine.run(walker, until=WalkEnd(walker, steps))
            reason = machine.loop.reason
        except DivergedError:
            reason = "fell"  # so violently that the physics gave up
        return {
            "requested": steps,
            "steps": walker.steps,
            "fell": reason == "fell",
            "arrived": reason == "done",
            "time": machine.loop.sim_time,
            **seen.result(),
        }


class _Seen:
    """What is kept of a walk: its steps, its motion, its flights, and how a human bends over."""

    def __init__(self, machine: Robot, walker: Balancer) -> None:
        robot = machine.description
        self._recorder = Recorder(walker, traced=True)
        self._gauges, self._bend = Gauges(robot.contacts), list[float]()
        self._bending = robot.joints.names.index(BEND) if BEND in robot.joints.names else 0

    def add(self, observation: Observation) -> None:
        """Take note of a tick."""
        self._recorder.add(observation)
        self._gauges.update(observation)
        if len(self._recorder.trace) > len(self._bend):  # as often as it keeps a sample
            self._bend.append(float(observation.joints.position[self._bending]))

    def result(self) -> Result:
        """Return all of it."""
        return {
            "flights": self._gauges.flights,
            "flight_time": self._gauges.flight_time,
            "bend": np.round(self._bend, 4).tolist(),
            **self._recorder.result(),
        }
