"""Walks by the product's own control, for what the thesis shows and its control alone does not."""

from dataclasses import replace
from typing import Any

import numpy as np

from windup.hal.errors import DivergedError
from windup.hal.observation import Observation
from windup.tools.assembly.build import body_of, build_walk
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.measures.gauges import Gauges
from windup.tools.measures.walk_end import WalkEnd
from windup.tools.reproduce.figure import Job, Result
from windup.tools.reproduce.laszlo.recorder import Recorder
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
        recorder = Recorder(body_of(machine.description), walker, traced=True)
        gauges = Gauges(machine.description.contacts)
        names, bend = machine.description.joints.names, list[float]()
        bending = names.index(BEND) if BEND in names else 0

        def watch(observation: Observation) -> None:
            recorder.add(observation)
            gauges.update(observation)
            if len(recorder.trace) > len(bend):  # as often as it keeps a sample
                bend.append(float(observation.joints.position[bending]))

        machine.watch.append(watch)
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
            "flights": gauges.flights,
            "flight_time": gauges.flight_time,
            "bend": np.round(bend, 4).tolist(),
            **recorder.result(),
        }
