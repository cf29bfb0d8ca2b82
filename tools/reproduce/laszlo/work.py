"""Running one job of the thesis: walks, and what a step does under scaled perturbations."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, cast

import numpy as np

from windup.control.limit_cycle.balancer import Balancer
from windup.control.limit_cycle.planner import StepPlanner
from windup.control.limit_cycle.step_model import Sample, StepModel
from windup.control.pose_graph.gait_file import Heading
from windup.control.regulation.variables import AXES, regulation_variables
from windup.hal.errors import DivergedError
from windup.hal.joints import Array
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.reproduce.laszlo.laws import ConstantTurn, SpeedLaw
from windup.tools.reproduce.laszlo.recorder import Recorder
from windup.tools.reproduce.laszlo.tours import run_tour
from windup.tools.reproduce.study.figure import Job, Result
from windup.tools.robot.robot import Robot

ROBOT = "human"
NOISE = 0.2  # degrees
TURN = "veer"  # the perturbation that turns
VECTORS = ("up", "swing_com", "stance_com")
PERTURBATIONS = ("stance_hip_pitch", "stance_hip_roll")


def work(job: Job) -> Result:
    """Run a job."""
    kinds: dict[str, Callable[..., Result]] = {
        "walk": walk,
        "response": response,
        "tour": run_tour,
    }
    return kinds[job.kind](**job.options)


def walk(
    *,
    rv: list[str],
    sampling: str,
    forward: float,
    lateral: float,
    servo: bool,
    steps: int,
    seed: int,
    open_loop: bool = False,
    law: dict[str, Any] | None = None,
    hold: float = 0.0,
    turn: float = 0.0,
    limits: bool = True,
) -> Result:
    """Walk with the thesis' control; seed 0 also keeps a trace of its motion.

    Args:
        rv: Regulation variables.
        sampling: "sp", "fl" or "lf".
        forward: Target of the forward variable.
        lateral: Target of the lateral variable, positive toward the foot that has swung.
        servo: With the torso servo.
        steps: How many.
        seed: Of the noise on the start pose.
        open_loop: Without balance.
        law: Eq. 5.1: arguments of `SpeedLaw`, or None for constant targets.
        hold: Added to every hold time, s.
        turn: Scaling of the turning perturbation, degrees, positive to the left.
        limits: Bound the scalings as the gait says; the thesis bounds none.
    """
    options = WalkOptions(
        rv=tuple(rv),
        sampling=cast(Any, sampling),
        target=() if law else (f"{forward}", *_lateral(rv, lateral)),
        torso_servo=servo,
        open_loop=open_loop,
    )
    with Robot.open(ROBOT, seed=seed, noise=NOISE) as robot:
        walker = build_walk(robot.description, options, robot.predictor)
        walker.steering.course = None
        if turn:
            walker.steering.course = ConstantTurn(Heading(TURN, gain=0.0), degrees=turn)
        _hold_longer(walker, hold)
        if law is not None:
            forward_name, lateral_name = (variable.name for variable in walker.regulation)
            bias = {forward_name: forward, lateral_name: lateral}
            walker.steering.speed = SpeedLaw(walker.gait, bias=bias, walker=walker, **law)
        if not limits and isinstance(walker.planner, StepPlanner):
            walker.planner.model.limits = np.full(len(walker.regulation), np.inf)
        return _walk(robot, walker, steps, traced=seed == 0)


def response(*, vary: int, step: int, scalings: list[float], seed: int) -> Result:
    """Return all regulation variables at the end of one step, for a scaled perturbation.

    Args:
        vary: Index of the perturbation, 0 pitch or 1 roll.
        step: Number of the step, from 1; the steps before it are open loop.
        scalings: Degrees.
        seed: Of the noise on the start pose.
    """
    options = WalkOptions(rv=("up",), sampling="sp", torso_servo=False)
    with Robot.open(ROBOT, seed=seed, noise=NOISE) as robot:
        walker = build_walk(robot.description, options, robot.predictor)
        walker.steering.course = None
        planner = cast(StepPlanner, walker.planner)
        planner.regulation = regulation_variables(list(VECTORS))
        tried = np.zeros((len(scalings), len(PERTURBATIONS)))
        tried[:, vary] = scalings
        probe = Probe(step, tried)
        planner.model = cast(StepModel, probe)
        _walk(robot, walker, step, traced=False)
    names = [f"{vector}.{axis}" for vector in VECTORS for axis in AXES]
    return {"names": names, "q": probe.values, "fell": probe.fell}


@dataclass
class Probe:
    """Looks like a step model, scales nothing, and samples one step widely.

    Attributes:
        step: Which step, from 1.
        tried: (m, p) scalings to sample.
        values: (m, r) regulation variables at its end.
        fell: Which samples fell.
    """

    step: int
    tried: Array
    values: list[list[float]] = field(default_factory=list)
    fell: list[bool] = field(default_factory=list)
    _step: int = 0

    def reset(self) -> None:
        """Begin again."""
        self._step = 0

    def control(
        self,
        sample: Sample,
        target: Array,
        side: int,
        start: Array | None = None,
        at: int | None = None,
    ) -> Array:
        """Return scalings of nothing; on the way, sample the step that was asked for."""
        self._step += 1
        if self._step == self.step:
            values, fell = sample(self.tried)
            self.values, self.fell = values.tolist(), fell.tolist()
        return np.zeros(self.tried.shape[1])


def _walk(robot: Robot, walker: Balancer, steps: int, *, traced: bool) -> Result:
    recorder = Recorder(walker, traced)
    robot.watch.append(recorder.add)
    robot.start_at(walker.gait.file.start)
    try:
        robot.run(walker, until=lambda _: "done" if walker.steps >= steps else None)
        fell = robot.loop.reason == "fell"
    except DivergedError:
        fell = True  # so violently that the physics gave up
    return {
        "requested": steps,
        "steps": walker.steps,
        "fell": fell,
        "time": robot.loop.sim_time,
        **recorder.result(),
    }


def _lateral(rv: list[str], value: float) -> list[str]:
    """Return the target of the lateral variable as `windup walk --target` writes it."""
    names = [variable.name for variable in regulation_variables(rv)]
    return [f"{name}={value}" for name in names if name.endswith(".lateral")]


def _hold_longer(walker: Balancer, seconds: float) -> None:
    """Add to every hold time of a walk's base graph."""
    if not seconds:
        return
    gait = walker.gait
    gait = replace(gait, graph=replace(gait.graph, hold=gait.graph.hold + seconds))
    walker.gait = gait
    if isinstance(walker.planner, StepPlanner):
        walker.planner.gait = gait
