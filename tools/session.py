"""A session on a backend: arm, run controllers in the loop, and stop whatever happens."""

import logging
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass, field

import numpy as np

from control.loop import LoopReport, Until, run_loop
from hal.clock import punctual
from hal.controller import Controller, Stopwatch
from hal.errors import (
    ControllerError,
    HardwareError,
    TelemetryError,
    UsageError,
    WindupError,
)
from hal.guard import GuardedBackend
from hal.guardian import Guardian, guardian_for
from hal.observation import BaseState, Observation
from hal.ranges import numbers_checked
from hal.telemetry import TelemetryWriter
from hal.torque_state import TorqueState
from robots import RobotDescription
from sim_twin.backend import TwinClock
from sim_twin.push import Push
from sim_twin.twin import Twin
from tools.interrupts import asked_to_end
from tools.protect import Protection
from tools.stack import Stack

INTERRUPTED = "interrupted"
# Called once a tick with the observation.
Watch = Callable[[Observation], None]


@dataclass
class Session:
    """A stack that controllers run on.

    Attributes:
        description: What robot it is.
        stack: Its backend and what belongs to it.
        period: Period of the control loop, s.
        paced: Its time is real time.
        protect: A fall that cannot be prevented is softened, where the robot's file says how.
        loop: Report of the last run.
        watch: Called with every observation, for whoever draws or logs.
        base: Base state last seen: the truth on a twin, an estimate on a robot.
        telemetry: Where everybody else can read how it goes, once it runs.
        guardian: Stops servos without a watchdog of their own should this process die.
    """

    description: RobotDescription
    stack: Stack
    period: float
    paced: bool = False
    protect: bool = True
    loop: LoopReport = field(default_factory=LoopReport, init=False)
    watch: Watch | None = field(default=None, init=False)
    base: BaseState | None = field(default=None, init=False)
    telemetry: TelemetryWriter | None = field(default=None, init=False)
    armed: bool = field(default=False, init=False)
    guardian: Guardian | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._protection = Protection(self.description)

    @property
    def backend(self) -> GuardedBackend:
        """The guarded backend."""
        return self.stack.backend

    @property
    def fallen(self) -> bool:
        """True when the robot has fallen."""
        if self.stack.twin is not None:
            return self.stack.twin.fallen
        if self.base is None:
            return False
        fall = self.description.fall
        _, x, y, _ = self.base.orientation
        tilted = 1.0 - 2.0 * (x * x + y * y) < np.cos(fall.tilt)
        return bool(self.base.position[2] < fall.height or tilted)

    @property
    def twin(self) -> Twin:
        """The twin behind the backend.

        Raises:
            UsageError: This is a robot, not a twin.
        """
        if self.stack.twin is None:
            raise UsageError("only a twin can do that; leave --port away")
        return self.stack.twin

    @numbers_checked
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
        start = self.twin.time + delay
        self.twin.push(Push.impulse(self.description.torso, impulse, direction, start, duration))

    @numbers_checked
    def shove(self, speed: float, direction: float = 0.0, *, delay: float = 0.0) -> None:
        """Give a whole twin `speed` m/s toward `direction` rad, `delay` s from now."""
        mass = float(self.twin.model.body_mass.sum())
        self.twin.push(Push.velocity_step(speed, mass, direction, self.twin.time + delay))

    def arm(self) -> None:
        """Switch the torque on at the present pose, where there are servos to switch.

        Raises:
            UsageError: The port is real and `arm` was not given; nothing has moved.
            HardwareError: A servo did not take it, or the guardian does not start; all torque is
                off again.
        """
        if not self.armed and self.stack.wired:
            self._arm(lambda: self.backend.set_torque(True))

    def rearm(self) -> None:
        """Switch the torque on again after a port was unplugged, at the pose of now.

        The servos are checked and set as when the robot was opened: some may have had no power.

        Raises:
            UsageError: As of `arm`.
            PortError: The port is still gone; torque is off wherever it can be reached.
            HardwareError: As of `arm`.
        """
        if self.stack.wired:
            self._arm(self.backend.rearm)

    def _arm(self, switch_on: Callable[[], TorqueState]) -> None:
        if not self.stack.may_arm:
            raise UsageError("this moves a robot: give --arm (arm=True), and hold on to it")
        if self.guardian is None or not self.guardian.alive:
            self.guardian = guardian_for(self.backend.backend, self.backend.stop_policy)
        self.armed = True
        state = switch_on()
        if not state.all_on:
            where = state.names(self.description.joints, ~state.on)
            raise HardwareError(f"torque does not come on at {where}; run `windup scan`")

    def stop(self, *, limp: bool = False) -> None:
        """Carry out the stop policy at once; with `limp`, just switch the torque off.

        Raises:
            HardwareError: Torque was told to go off and a joint read back on.
        """
        self.armed = not self.backend.stop("limp" if limp else None).all_off
        if not self.armed:
            self._release()

    @numbers_checked
    def run(
        self,
        controller: Controller,
        seconds: float | None = None,
        *,
        until: Until | None = None,
        rollouts: Stopwatch | None = None,
        down: bool = False,
    ) -> LoopReport:
        """Run a controller until the time is over, `until` gives a reason, or the robot falls.

        Where the robot falls `protect`ed, until it lies still.

        Args:
            controller: The controller.
            seconds: How long, s of the backend's clock; for ever if None.
            until: Called with each observation; a reason ends the run.
            rollouts: Time to leave out of the ticks.
            down: The robot may lie: a fall does not end the run.

        Raises:
            WindupError: From the guard, the backend or the controller; the stop policy has run.
        """
        protected = None
        if self.protect and self._protection.possible and not down:
            controller = protected = self._protection.around(controller)
        with asked_to_end() as asked:
            self.arm()
            begin = self.backend.clock.now()

            def end(observation: Observation) -> str | None:
                self.base = observation.base
                if self.watch is not None:
                    self.watch(observation)
                if asked():
                    return INTERRUPTED
                if protected is not None and protected.active:
                    return self._landed() if protected.finished else None
                if self.fallen and not down:
                    return "fell"
                if until is not None and (reason := until(observation)) is not None:
                    return reason
                over = seconds is not None and observation.time >= begin + seconds - 1e-9
                return "done" if over else None

            self._run(controller, end, rollouts)
        if self.loop.reason == INTERRUPTED:
            raise KeyboardInterrupt
        return self.loop

    def _landed(self) -> str:
        """Return why a run ends whose fall is over."""
        return "fell" if self.fallen else "braced for a fall that did not come"

    def _run(self, controller: Controller, end: Until, rollouts: Stopwatch | None) -> None:
        """Run the loop; stop the robot if it ends by an error or a wish."""
        self.loop = LoopReport()
        self._publish()
        try:
            with punctual() if self.paced else nullcontext():
                if isinstance(self.backend.clock, TwinClock):
                    self.backend.clock.align()
                run_loop(
                    self.backend,
                    controller,
                    period=self.period,
                    until=end,
                    estimator=self.stack.estimator,
                    rollouts=rollouts,
                    report=self.loop,
                    recorder=self.telemetry,
                )
            if self.loop.reason == INTERRUPTED:
                self._stop_after_error()
        except WindupError as error:
            self.loop.reason = str(error)
            self._stop_after_error()
            raise
        except KeyboardInterrupt:
            self.loop.reason = INTERRUPTED
            self._stop_after_error()
            raise
        except Exception as error:
            self.loop.reason = f"the controller failed: {type(error).__name__}: {error}"
            self._stop_after_error()
            raise ControllerError(self.loop.reason) from error
        finally:
            if self.telemetry is not None:
                self.telemetry.end(self.loop.reason)

    def _release(self) -> None:
        if self.guardian is not None:
            self.guardian.release()
            self.guardian = None

    def _publish(self) -> None:
        """Say to everybody that a run begins; a robot runs without them all the same."""
        try:
            self.telemetry = self.telemetry or TelemetryWriter(
                self.description.name,
                self.backend,
                self.description.contacts,
                1.0 / self.period,
                port=self.stack.port,
            )
            self.telemetry.begin()
        except TelemetryError as error:
            logging.getLogger(__name__).warning("no telemetry: %s", error)

    def _stop_after_error(self) -> None:
        """Carry out the stop policy; a twin that has diverged can no longer do it."""
        try:
            self.stop()
        except WindupError as error:
            self.loop.reason += f"; and the stop failed: {error}"

    def close(self) -> None:
        """Disconnect; call it when the torque is off."""
        self.stack.close()
        self._release()
        if self.telemetry is not None:
            self.telemetry.close()
