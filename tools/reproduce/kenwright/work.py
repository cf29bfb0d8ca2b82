"""Running one job of the study: a push on a twin, as `windup push` does it, with a trace."""

from dataclasses import replace
from math import cos, radians, sin
from typing import Any

import numpy as np

from windup.robots import load_robot
from windup.sim_twin.ground.touch import TouchWatch
from windup.sim_twin.impact import ImpactGauge
from windup.tools.assembly.stepping import find_stepping, footing_of, stepping_stance
from windup.tools.behaviours.push_trial import push_robot
from windup.tools.behaviours.run_record import RunRecord
from windup.tools.behaviours.stride import STRIDE
from windup.tools.behaviours.striding import StrideTrace
from windup.tools.commands.push import Push
from windup.tools.commands.stride import Stride
from windup.tools.measures.fall_report import fall_result
from windup.tools.reproduce.kenwright.recorder import Recorder
from windup.tools.reproduce.study.figure import Job, Result
from windup.tools.robot.robot import Robot

ARMS = ("l_el_link", "r_el_link")
PLAN = ("impulse", "way", "height", "duration", "every", "body", "stance", "support", "forbid")


def work(job: Job) -> Result:
    """Run one job, in any process."""
    options = dict(job.options)
    kinds = {"push": _push, "fall": _fall, "stride": _stride}
    return kinds[job.kind](options)


def _push(options: dict[str, Any]) -> Result:
    """Push a robot that stands, and note where its feet go."""
    push = _command(options)
    with _open(push, options) as robot:
        plan = replace(push.plan(push.seed), directions=tuple(options["directions"]))
        stance = stepping_stance(robot.description, plan.stance)
        recorder = Recorder(robot, footing_of(robot.description, stance))
        result = push_robot(robot, plan, look=recorder)
    return result | {"trace": np.round(recorder.rows, 5).tolist(), "begun": recorder.steps}


def _fall(options: dict[str, Any]) -> Result:
    """Push a robot over, and note how its trunk and arms met the floor."""
    push = _command(options)
    with _open(push, options) as robot:
        robot.protect = options["protect"]
        plan = replace(push.plan(push.seed), directions=tuple(options["directions"]))
        gauge, arms = ImpactGauge(robot.twin), _Arms(robot, plan.directions[0])
        result = push_robot(robot, plan, to_the_end=True)
    return result | fall_result(gauge) | {"reach": arms.reach, "powered": arms.powered}


def _stride(options: dict[str, Any]) -> Result:
    """Let a robot stride, and note its way."""
    then = tuple(options.pop("then", ()))
    command = Stride(robot="op3", then=then, **options)
    with command.open_behaving(command.seed) as robot:
        run = RunRecord(robot, command.options)
        STRIDE.perform(run)
        trace: StrideTrace = run.measured
        return {"path": [list(row) for row in trace.rows]} | STRIDE.report(run).result


class _Arms:
    """Where the arms are when anything but a foot first touches the floor.

    Attributes:
        reach: How far the farther forearm is from the trunk toward the fall, m.
        powered: Whether the servos still held.
    """

    def __init__(self, robot: Robot, direction: float) -> None:
        self._twin = robot.twin
        self._toward = np.array([cos(radians(direction)), sin(radians(direction))])
        self._touch = TouchWatch(robot.description, robot.twin.model, robot.twin.data)
        self._torso = robot.description.torso
        self.reach = float("nan")
        self.powered = True
        self._also, robot.twin.on_step = robot.twin.on_step, self._look

    def _look(self) -> None:
        if self._also is not None:
            self._also()
        if self._touch.touched:
            return
        self._touch.update()
        if self._touch.touched:
            data = self._twin.data
            trunk = data.body(self._torso).xipos
            ways = [(data.body(arm).xipos - trunk)[:2] @ self._toward for arm in ARMS]
            self.reach, self.powered = float(max(ways)), self._twin.powered


def _command(options: dict[str, Any]) -> Push:
    """Return the command line that these options are."""
    known = {name: options[name] for name in PLAN if name in options}
    known["forbid"] = tuple(known.get("forbid", ()))
    return Push(robot="op3", seed=options["seed"], noise=options["noise"], **known)


def _open(push: Push, options: dict[str, Any]) -> Robot:
    rate = find_stepping(load_robot(push.robot)).rate
    push = replace(push, rate=rate, state=options["state"])
    return push.open_robot(push.seed, delay=options["delay"])
