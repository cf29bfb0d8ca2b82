"""The process that plans steps for a loop on the wall's time; `plan_process` starts it.

It is a program of its own, not a spawn of multiprocessing, so that a script which runs a robot
needs no `if __name__ == "__main__"`. Each message is one pickle on a socket that keeps
messages apart. First comes a `Task`, answered when everything is built and warm; then requests.
"""

import contextlib
import gc
import os
import pickle
import signal
import socket
import sys
from dataclasses import dataclass, replace
from pathlib import Path

from windup.control.limit_cycle.balancer import Balancer
from windup.control.limit_cycle.planner import StepPlanner, StepRequest
from windup.hal.controller import Stopwatch
from windup.hal.errors import WindupError
from windup.hal.joints import Array
from windup.robots import load_robot
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.ground.terrain import Ground
from windup.sim_twin.rollouts import RolloutPredictor
from windup.sim_twin.twin import Twin
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.walk_options import WalkOptions

LARGEST = 1 << 17
"""More than any message, bytes."""
FLAT = Ground()
NICENESS = 1
"""Below the loop, and not below everybody else: a plan that is late costs balance."""


@dataclass(frozen=True)
class Task:
    """What to plan for; everything else is built from it.

    Attributes:
        robot: The robot's folder.
        options: How it walks.
        delay: From a state being sensed to its command acting, s.
        latency: From the start of a step to its scalings acting, s.
        period: Period of the loop, s.
        ground: The ground as far as it is known.
    """

    robot: Path
    options: WalkOptions
    delay: float
    latency: float
    period: float
    ground: Ground = FLAT


@dataclass(frozen=True)
class Question:
    """A step to be planned, with a number from 1; the first of a walk is `fresh`."""

    number: int
    request: StepRequest
    fresh: bool = False


@dataclass(frozen=True)
class Answer:
    """Scalings (r,) for the question `number`, and what they took; or what went wrong.

    Number 0 says that everything is ready.
    """

    number: int
    scalings: Array | None = None
    rollouts: int = 0
    seconds: float = 0.0
    error: str | None = None


def serve(link: socket.socket) -> None:
    """Answer questions until the other side is gone."""
    try:
        task = pickle.loads(link.recv(LARGEST))
        planner, stopwatch = build(task)
        gc.collect()
        gc.freeze()
        link.send(pickle.dumps(Answer(0)))
        while (question := _newest(link)) is not None:
            link.send(pickle.dumps(answer(planner, stopwatch, question)))
    except (ConnectionError, EOFError):
        return
    except Exception as error:
        _say_why(link, error)


def build(task: Task) -> tuple[StepPlanner, Stopwatch]:
    """Return the planner of a task, with its first rollouts behind it, and its stopwatch."""
    robot = load_robot(task.robot)
    predictor = RolloutPredictor(robot, delay=task.delay, ground=task.ground)
    walker = build_walk(robot, task.options, predictor, latency=task.latency)
    assert isinstance(walker.planner, StepPlanner), "an open loop has nothing to plan"
    _warm_up(walker, Twin(robot), task.period)
    predictor.stopwatch = Stopwatch()
    return walker.planner, predictor.stopwatch


def _warm_up(walker: Balancer, twin: Twin, period: float) -> None:
    """Plan the first step of a robot at rest: what is built on first use is built now."""
    observation = TwinBackend(twin).read()
    walker.reset(observation)
    walker.step(observation, period)
    assert walker.planner is not None
    walker.planner.reset()


def answer(planner: StepPlanner, stopwatch: Stopwatch, question: Question) -> Answer:
    """Return the scalings that a question asks for."""
    if question.fresh:
        planner.reset()
    count, seconds = stopwatch.count, stopwatch.seconds
    scalings = planner.plan(question.request)
    return Answer(question.number, scalings, stopwatch.count - count, stopwatch.seconds - seconds)


def _newest(link: socket.socket) -> Question | None:
    """Wait for a question and return the last one there is; None when nobody will ask again."""
    fresh = False
    message = link.recv(LARGEST)
    while message:
        question: Question = pickle.loads(message)
        fresh |= question.fresh
        try:
            message = link.recv(LARGEST, socket.MSG_DONTWAIT)
        except BlockingIOError:
            return replace(question, fresh=fresh)
    return None


def _say_why(link: socket.socket, error: Exception) -> None:
    text = str(error) if isinstance(error, WindupError) else f"{type(error).__name__}: {error}"
    with contextlib.suppress(OSError):
        link.send(pickle.dumps(Answer(0, error=text)))


def main() -> None:
    """Serve the socket whose descriptor is the only argument."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the loop's; it closes the socket
    os.nice(NICENESS)
    with socket.socket(fileno=int(sys.argv[1])) as link:
        serve(link)
