"""Planning steps in a process of its own, for a loop on the wall's time."""

import contextlib
import os
import pickle
import select
import socket
import subprocess
import sys
import time as wall
from types import TracebackType
from typing import Self

from windup.control.limit_cycle.planner import StepRequest
from windup.hal.controller import Stopwatch
from windup.hal.errors import PlannerError
from windup.hal.guardian.child_path import child_python_path
from windup.hal.joints import Array
from windup.robots import RobotDescription
from windup.sim_twin.rollouts import RolloutPredictor
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.planning.plan_worker import LARGEST, Answer, Question, Task

PATIENCE = 60.0
"""For the process to be built, on a machine that is busy, s."""
PROGRAM = "from windup.tools.planning.plan_worker import main; main()"
GOODBYE = 2.0
"""For the process to end by itself, s."""


class ProcessPlanner:
    """A planner that neither computes nor waits in the caller's time.

    An answer acts `latency` s into its step: what comes before waits here, what comes later acts
    when it comes, and what comes after its step is thrown away.

    Args:
        task: What to plan for.
        stopwatch: Counts the rollouts, and the time that they took over there.

    Attributes:
        discarded: Answers that came after their step, and questions that found no room.
    """

    def __init__(self, task: Task, stopwatch: Stopwatch | None = None) -> None:
        self.task, self.stopwatch = task, stopwatch or Stopwatch()
        self.discarded = 0
        self._number = 0
        self._fresh = True
        self._due = 0.0
        self._answer: Array | None = None
        self._link, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with other:
            self._process = _start(other.fileno())
        self._link.send(pickle.dumps(task))

    @property
    def latency(self) -> float:
        """From the start of a step to its scalings acting, s."""
        return self.task.latency

    def ready(self) -> bool:
        """Return True when `wait_ready` would not wait."""
        poll = select.poll()  # select() takes no descriptor beyond 1023
        poll.register(self._link, select.POLLIN)
        return bool(poll.poll(0))

    def wait_ready(self, patience: float = PATIENCE) -> Self:
        """Return when the process has built everything: before the run, never in it.

        Raises:
            PlannerError: It cannot, or takes longer than `patience` s.
        """
        deadline = wall.monotonic() + patience
        try:
            self._link.settimeout(max(deadline - wall.monotonic(), 1e-3))
            self._read()
        except TimeoutError:
            raise PlannerError(
                f"the process that plans steps was not ready after {patience:g} s; "
                "is the machine busy? run again, or without `--realtime`"
            ) from None
        self._link.setblocking(False)
        return self

    def reset(self) -> None:
        """Forget all steps."""
        self._number += 1
        self._fresh = True
        self._answer = None

    def ask(self, request: StepRequest) -> None:
        """Ask for a step; older ones are no longer of interest."""
        self._number += 1
        self._answer, self._due = None, request.due(self.latency)
        question = Question(self._number, request, self._fresh)
        try:
            self._link.send(pickle.dumps(question, pickle.HIGHEST_PROTOCOL))
            self._fresh = False
        except BlockingIOError:
            self.discarded += 1
        except OSError:
            raise self._dead() from None

    def answer(self, time: float) -> Array | None:
        """Return the scalings (r,) of the present step, once they are here and may act."""
        while self._answer is None:
            try:
                self._take(self._read())
            except BlockingIOError:
                return None
        if time < self._due:
            return None
        answer, self._answer = self._answer, None
        return answer

    def close(self) -> None:
        """End the process."""
        self._link.close()
        try:
            self._process.wait(GOODBYE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _read(self) -> Answer:
        try:
            message = self._link.recv(LARGEST)
        except ConnectionError:
            message = b""
        if not message:
            raise self._dead()
        answer: Answer = pickle.loads(message)
        if answer.error is not None:
            raise PlannerError(f"the process that plans steps failed: {answer.error}")
        return answer

    def _take(self, answer: Answer) -> None:
        self.stopwatch.add(answer.rollouts, answer.seconds)
        if answer.number == self._number:
            self._answer = answer.scalings
        else:
            self.discarded += 1

    def _dead(self) -> PlannerError:
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(0.05)
        code = self._process.returncode
        how = f"signal {-code}" if code is not None and code < 0 else f"exit status {code}"
        return PlannerError(
            f"the process that plans steps has died ({how}); was it killed, or is memory short? "
            "run again, or with `--open-loop`"
        )


def plan_aside(
    robot: RobotDescription, options: WalkOptions, predictor: RolloutPredictor, period: float
) -> ProcessPlanner:
    """Return a process that plans what `predictor` would have played; its stopwatch counts."""
    latency = robot.model_latency
    task = Task(robot.folder, options, predictor.delay, latency, period, predictor.ground)
    return ProcessPlanner(task, predictor.stopwatch)


def _start(descriptor: int) -> subprocess.Popen[bytes]:
    """Start the worker."""
    return subprocess.Popen(
        [sys.executable, "-P", "-c", PROGRAM, str(descriptor)],
        pass_fds=(descriptor,),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": child_python_path()},
    )
