"""The process that owns a robot: it runs what clients order, and between two behaviours holds."""

from typing import Final

from windup.hal.errors import HardwareError, UsageError, WindupError
from windup.hal.observation import Observation
from windup.hal.publishing.run_state import RunState
from windup.tools.remote.messages import Refused, Run, Started
from windup.tools.reports.run_report import RunReport
from windup.tools.robot.robot import Robot
from windup.tools.runtime.behaviour_run import SETTLE, BehaviourRun
from windup.tools.runtime.board import TICKS, Board
from windup.tools.runtime.follow_goals import GoalFollower, largest_speed
from windup.tools.runtime.inbox import NOBODY, Inbox
from windup.tools.runtime.limp import Limp
from windup.tools.runtime.present_state import PresentState
from windup.tools.runtime.start_broker import BrokerProcess
from windup.tools.stopping.break_off import BreakOff
from windup.tools.stopping.interrupts import SIGNAL_NAMES, RunInterruptedError

LOOK: Final = 64
"""Ticks between two looks at whether the broker lives."""
PAUSE: Final = 0.1
"""Time from an error to the next try to read the robot, s."""


class Owner:
    """Owns a robot, and does one after the other what its clients order.

    Args:
        robot: The robot, open.
        board: The board that is shared with the broker.
        broker: The broker.
    """

    def __init__(self, robot: Robot, board: Board, broker: BrokerProcess) -> None:
        self._robot, self._session = robot, robot.session
        self._board, self._broker = board, broker
        self._state = PresentState(robot.session, board, broker.ring)
        self._inbox = Inbox(robot.session, board, broker.ring, self._state)
        self._wired = robot.stack.wired
        self._may_hold = not self._wired or robot.stack.may_arm
        self._off = "" if self._may_hold else "torque is off: begin the runtime with --arm"
        self._upright = not self._wired
        self._session.watch += [self._inbox.look, self._look_at_broker]
        self._session.break_off = BreakOff(self._inbox.broken_off)

    def serve(self) -> None:
        """Serve until a client wants the runtime to go down.

        Raises:
            RunInterruptedError: A signal has stopped the robot, and ends the runtime.
            HardwareError: The broker has ended.
        """
        while not self._inbox.down:
            try:
                self._wait()
                order, self._inbox.next = self._inbox.next, None
                if order is not None and isinstance(order.message, Run):
                    self._run(order.client, order.message)
            except RunInterruptedError as stopped:
                if stopped.by in SIGNAL_NAMES.values():
                    raise
                self._keep_off(f"{self._robot.description.name} was stopped by {stopped.by}")
            except WindupError as error:
                self._fault(str(error))
        if not self._broker.alive:
            raise HardwareError("the broker has died, so no client can be heard; begin anew")

    def _look_at_broker(self, observation: Observation) -> None:
        """Go down when the broker has died."""
        if self._board.words[TICKS] % LOOK == 0 and not self._broker.alive:
            self._inbox.go_down()

    def _keep_off(self, why: str) -> None:
        """Keep torque off until a client wants it on again."""
        self._off = f"{why}; give --arm to switch its torque on again"
        self._inbox.drop(self._off)

    def _fault(self, error: str) -> None:
        """Publish an error, after which torque stays off; wait before the robot is read again."""
        if not self._state.faulted:
            self._inbox.report(NOBODY, Refused(message=error))
        self._keep_off(error)
        self._state.off = self._state.faulted = True
        self._state.put(RunState.FAULTED)
        clock = self._robot.backend.clock
        clock.wait_until(clock.now() + PAUSE)

    def _wait(self) -> None:
        """Hold the robot, or leave it limp, until there is an order."""
        self._state.off = bool(self._off) or (self._wired and not self._robot.armed)
        if self._state.off:  # also before the first behaviour: no pose is known in which it stands
            self._be_limp()
            return
        last = self._robot.backend.last
        holder = GoalFollower(
            self._robot.joints,
            self._board,
            largest_speed(self._robot.joints),
            self._ready,
            None if last is None else last[1].position,
        )
        self._robot.run(holder, until=self._inbox.ordered, down=not self._upright)
        self._check_fallen()

    def _be_limp(self) -> None:
        """Read the robot without torque until there is an order."""
        report, session = RunReport(), self._session
        limp = Limp(self._robot.joints, lambda: session.fallen)
        with (
            session.prepared(
                report, limp, None, until=self._inbox.ordered, down=True, needs_imu=False,
                may_move=False,
            ) as run,
            session.looping(run) as loop,
        ):  # fmt: skip
            while loop is not None and loop.observe() is not None:
                loop.finish()

    def _ready(self) -> bool:
        """Return whether goals may be followed: every joint has been seen to follow its own."""
        start = self._robot.start
        return start is None or not start.motion.due

    def _check_fallen(self) -> None:
        """Go limp where the robot has fallen."""
        if self._upright and self._robot.fallen:
            self._upright = False
            self._robot.stop(limp=True)
            self._keep_off(f"{self._robot.description.name} has fallen")

    def _run(self, client: int, order: Run) -> None:
        """Run a behaviour, and report to its client how it went."""
        try:
            run = BehaviourRun(self._robot, order)
            self._arm_again(order)
        except WindupError as error:
            refused = Refused(message=str(error), exit_status=error.exit_status, id=order.id)
            self._inbox.report(client, refused)
            return
        except Exception as error:  # of the user's own code
            said = f"{order.behaviour}: {type(error).__name__}: {error}"
            self._inbox.report(client, Refused(message=said, id=order.id))
            return
        self._inbox.report(client, Started(id=order.id))
        self._inbox.begin(client, order.behaviour)
        self._state.begin(order.behaviour)
        watch = self._session.watch[:]
        ended, stopped = run.perform()
        self._session.watch[:] = watch  # without those of the behaviour
        self._inbox.end()
        self._state.end()
        try:
            if stopped is not None:
                self._state.off = True
                raise stopped
            self._upright = True
            self._check_fallen()
            if run.walks and not ended.good and self._upright:
                self._robot.stand(SETTLE)
        finally:
            self._state.update()
            self._inbox.report(client, ended)

    def _arm_again(self, order: Run) -> None:
        """Switch torque on again after a stop, if the client wants it.

        Raises:
            UsageError: It does not, or the runtime was begun without --arm.
        """
        if not self._off:
            return
        if not order.arm or not self._may_hold:
            raise UsageError(self._off)
        if self._wired:
            self._robot.rearm()
        else:
            self._robot.backend.set_torque(True)
        self._off, self._state.faulted = "", False
