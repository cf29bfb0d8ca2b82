"""Running one job of the study, as `windup push` and `windup footprints` do it."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import radians
from typing import Any

import numpy as np

from windup.control.footprints.footprints import Footprint
from windup.control.stepping.stepper import Stepper
from windup.hal.controller import Controller
from windup.hal.observation import Observation
from windup.robots import load_robot
from windup.tools.assembly.stepping import find_stepping
from windup.tools.behaviours.directed import (
    DirectedWalk,
    build_checks,
    build_directed,
    feet_of,
    loop_rate,
    walk_prints,
)
from windup.tools.behaviours.push_trial import push_robot
from windup.tools.commands.push import Push
from windup.tools.reproduce.study.figure import Job, Result
from windup.tools.reproduce.wu_zordan.jobs import DURATION
from windup.tools.robot.robot import Robot

HUMAN = "human"
AT = 0.3
"""When the first push comes, s; the human stands still from the start."""


def work(job: Job) -> Result:
    """Run one job, in any process."""
    options = dict(job.options)
    if job.kind == "push":
        return _push(options)
    robot, steps = options["robot"], options["steps"]
    checks = build_checks(load_robot(robot))
    if job.kind == "walk":
        return _walk(robot, checks.draw(steps, np.random.default_rng(options["seed"])))
    prints = []
    for number in range(steps):
        foot = number % 2
        beside = checks.homes[foot] - checks.homes[1 - foot]
        # Wider by the arc of its toes: turned feet need the room.
        wider = 1.2 if foot == 0 else 1.0
        angle = radians(options["angle"]) if foot == 0 else 0.0
        prints.append(Footprint(foot, np.array([beside[0], wider * beside[1], angle])))
    return _walk(robot, prints) | {"turned": options["angle"] * (steps // 2)}


@dataclass
class Steps:
    """Notes each step that a fall forces at its beginning.

    Attributes:
        begun: Times, s.
    """

    begun: list[float] = field(default_factory=list)
    _count: int = 0

    def __call__(self, observation: Observation, controller: Controller) -> None:
        """Look at a tick."""
        if isinstance(controller, Stepper) and controller.steps > self._count:
            self._count = controller.steps
            self.begun.append(observation.time)


def _push(options: dict[str, Any]) -> Result:
    push = Push(
        robot=HUMAN,
        impulse=options["force"] * DURATION,
        way=options["way"],
        duration=DURATION,
        at=AT,
        every=options.get("every", 1.0),
        protect=False,
        rate=find_stepping(load_robot(HUMAN)).rate,
    )
    plan = replace(push.plan(0), directions=tuple(options["directions"]))
    steps = Steps()
    with push.open_robot(0) as robot:
        robot.protect = False
        start = robot.twin.time + AT
        result = push_robot(robot, plan, look=steps)
    return result | {"force": options["force"], "begun": [time - start for time in steps.begun]}


def _walk(name: str, prints: Sequence[Footprint]) -> Result:
    description = load_robot(name)
    controller = build_directed(description, prints)
    with Robot.open(name, rate=loop_rate(description)) as robot:
        robot.start_at(controller.how.stance)
        walk = DirectedWalk(feet_of(description), controller.prints, controller.how)
        walk_prints(robot, controller, walk)
    return walk.record()
