"""The methods of an open robot that do not depend on its motions, delegated to its session."""

from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from windup.hal.command import JointCommand
from windup.hal.controller import Controller, Stopwatch
from windup.hal.joints import Joints
from windup.hal.observation import BaseState, Observation

if TYPE_CHECKING:
    from windup.control.loop import Until
    from windup.hal.guard import GuardedBackend
    from windup.hal.guard.finding import Finding
    from windup.hal.guard.imu_watch import ImuWatch
    from windup.robots import RobotDescription
    from windup.sim_twin.twin import Twin
    from windup.tools.reports.run_report import RunReport
    from windup.tools.robot.run_telemetry import RunTelemetry
    from windup.tools.robot.session import Session
    from windup.tools.robot.stack import Stack
    from windup.tools.robot.start import Start
    from windup.tools.robot.ticks import Ticks
    from windup.tools.robot.watched import Watch
    from windup.tools.stopping.custody import Custody
    from windup.tools.terminal.slowness import Slowness


class _OfSession:
    """A descriptor: the attribute of the same name of the session."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, handle: "Handle | None", owner: type) -> Any:
        return self if handle is None else getattr(handle.session, self._name)

    def __set__(self, handle: "Handle", value: object) -> None:
        setattr(handle.session, self._name, value)


def _of_session() -> Any:
    return _OfSession()


class Handle:
    """An open robot.

    Args:
        session: Its session.
    """

    description: "RobotDescription" = _of_session()
    """Its description: joints, servos, poses, limits."""
    fallen: bool = _of_session()
    """True if the robot has fallen, at this moment; the `fallen` of a report is that of its end."""
    armed: bool = _of_session()
    """Torque was switched on, and has not been read back as off since."""
    base: BaseState | None = _of_session()
    """Base state last seen: the truth on a twin, an estimate on a robot."""
    loop: "RunReport" = _of_session()
    """Report of the last run."""
    period: float = _of_session()
    """Period of the control loop, s."""
    paced: bool = _of_session()
    """The loop runs in real time."""
    protect: bool = _of_session()
    """A fall that cannot be prevented is softened, where the robot's file says how."""
    record: bool = _of_session()
    """Each run records its ticks for the arrays of its report."""
    watch: "list[Watch]" = _of_session()
    """Callbacks, each called with every observation; for drawing and logging."""
    warnings: "list[Finding]" = _of_session()
    """Warnings so far, one finding a kind."""
    twin: "Twin" = _of_session()
    """The twin behind the backend; a UsageError on a robot."""
    stack: "Stack" = _of_session()
    """Its backend and what belongs to it."""
    backend: "GuardedBackend" = _of_session()
    """The guarded backend."""
    telemetry: "RunTelemetry" = _of_session()
    """What other processes can read of its runs."""
    imu: "ImuWatch" = _of_session()
    """Detects faults of the IMU, where the base state is estimated from it."""
    slowness: "Slowness" = _of_session()
    """Number of late ticks and plans in all runs."""
    custody: "Custody" = _of_session()
    """The guardian of the torque, and the holding between runs."""
    start: "Start | None" = _of_session()
    """Checks and first motion before the first command; None without servos."""

    def __init__(self, session: "Session") -> None:
        self.session = session

    @property
    def joints(self) -> Joints:
        """The joints, in MJCF order."""
        return self.description.joints

    def read(self) -> Observation:
        """Return the observation of the present tick; outside of a run, a new one.

        The time of a twin passes in ticks, writes and runs only: to read it twice in a row gives
        the same instant twice, which is warned of.

        Raises:
            WindupError: The robot is closed, or from the backend or the guard.
        """
        return self.session.read()

    def write(self, command: JointCommand) -> JointCommand:
        """Send a command, and return the command that the joints really got.

        In the body of a loop over `ticks` it is the command of that tick. Elsewhere it is a tick by
        itself, which returns when the next one is due; falls are looked for in ticks only.

        Raises:
            UsageError: It is no command, or the torque is off; nothing was sent.
            WindupError: From the guard or the backend; the robot has stopped.
        """
        return self.session.write(command)

    def ticks(
        self, seconds: float | None = None, *, down: bool = False, needs_imu: bool = False
    ) -> "Ticks":
        """Return the ticks of a run, for a `for` loop whose body is the controller.

        ::

            for observation in robot.ticks(seconds=5):
                robot.write(JointCommand.of(robot.joints, position=...))

        What the body writes is the command of its tick; without, the last one is held, at first
        the last goal, or the pose of now. All rules of `run` hold. A loop that is left by `break`
        or an exception leaves the robot held, as after a run. On servos whose torque has just come
        on, the first motion comes first: to the stance or, with `down`, to the present pose. On a
        port that was opened without `arm=True`, the body can only read.

        Args:
            seconds: How long, s of the backend's clock; for ever if None.
            down: As of `run`.
            needs_imu: As of `run`.
        """
        return self.session.ticks(seconds, down=down, needs_imu=needs_imu)

    def run(
        self,
        controller: Controller,
        seconds: float | None = None,
        *,
        until: "Until | None" = None,
        rollouts: Stopwatch | None = None,
        down: bool = False,
        needs_imu: bool = False,
    ) -> "RunReport":
        """Run a controller until the time is over, `until` gives a reason, or the robot falls.

        Where the robot falls `protect`ed, until it lies still.

        Args:
            controller: The controller.
            seconds: How long, s of the backend's clock; for ever if None. On servos that were just
                armed, from the end of the first motion on.
            until: Called with each observation; a reason ends the run.
            rollouts: Time to leave out of the ticks.
            down: The robot may lie: a fall does not end the run.
            needs_imu: The controller balances with the IMU, or decides by it: one that fails stops
                the robot. Without, that is a warning.

        Raises:
            UsageError: It is no controller, or `seconds` is negative; nothing has moved.
            PostureError: It was to be armed, and a joint is outside of its limits, or it needs its
                feet (not `down`) and sits or lies.
            FirstMotionError: A joint did not follow in the first motion; the robot is limp.
            WindupError: From the guard, the backend or the controller; the stop policy has run.
        """
        return self.session.run(
            controller, seconds, until=until, rollouts=rollouts, down=down, needs_imu=needs_imu
        )

    def push(
        self, impulse: float, direction: float = 0.0, *, duration: float = 0.1, delay: float = 0.0
    ) -> None:
        """Push the torso of a twin.

        Args:
            impulse: N s.
            direction: rad; 0 pushes forward, positive to the left.
            duration: s.
            delay: s from now.
        """
        self.session.push(impulse, direction, duration=duration, delay=delay)

    def shove(self, speed: float, direction: float = 0.0, *, delay: float = 0.0) -> None:
        """Give a whole twin `speed` m/s toward `direction` rad, `delay` s from now."""
        self.session.shove(speed, direction, delay=delay)

    def arm(self) -> None:
        """Switch the torque on at the present pose, where there are servos to switch.

        Also what a program has to call that goes on after it was interrupted.

        Raises:
            UsageError: The port is real and `arm` was not given, or the robot is closed; nothing
                has moved.
            HardwareError: A servo did not take it, or the guardian does not start; all torque is
                off again.
            KeyboardInterrupt: A signal came meanwhile; all torque is off again.
        """
        self.session.arm()

    def rearm(self) -> None:
        """Switch the torque on again after a port was unplugged, at the pose of now.

        The servos are checked and set as when the robot was opened: some may have had no power.

        Raises:
            UsageError: As of `arm`.
            PortError: The port is still gone; torque is off wherever it can be reached.
            HardwareError: As of `arm`.
            KeyboardInterrupt: As of `arm`.
        """
        self.session.rearm()

    def stop(self, *, limp: bool = False) -> None:
        """Carry out the stop policy at once; with `limp`, just switch the torque off.

        Signals do not interrupt it; three of them leave out a crouch. While a run is going on, it
        ends the run, which stops the robot: at the next tick, where the run calls this itself.

        Raises:
            UsageError: The robot is closed.
            HardwareError: Torque was told to go off and a joint read back on, or not at all.
            KeyboardInterrupt: A signal came meanwhile; the robot has stopped.
        """
        self.session.stop(limp=limp)

    def rest(self) -> None:
        """Crouch, if the robot has a pose for it, and switch the torque off."""
        self.session.rest()

    def close(self) -> None:
        """Rest and disconnect, as at the end of a `with`; once more is no matter.

        Raises:
            HardwareError: Torque is not off at every joint; the guardian has the robot now.
        """
        self.session.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.session.__exit__(kind, error, trace)
