"""`Robot`: a stack of backend, guard, estimator and loop; the only place where one is put together.

with Robot.open("op3") as robot:              # its twin
    report = robot.walk(speed=0.2, steps=40)
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from types import TracebackType
from typing import Self

from control.balancer import Balancer
from control.loop import Estimator, LoopReport, Until, run_loop
from control.play import GraphPlayer, PoseHolder
from hal.controller import Controller, Stopwatch
from hal.errors import UnknownNameError, UsageError, WindupError
from hal.guard import GuardedBackend, SafetyLimits
from hal.observation import Observation
from robots import RobotDescription, load_robot
from sim_twin.backend import TwinBackend
from sim_twin.imu_errors import OPENCR, ImuErrors
from sim_twin.push import Push
from sim_twin.rollouts import RolloutPredictor
from sim_twin.twin import Twin
from tools.build import WalkOptions, build_estimator, build_walk, find_gait
from tools.options import State
from tools.report import WalkReport

START_SECONDS = 1.0
# Called once a tick with the observation and the controller.
Watch = Callable[[Observation], None]
# Called at the end of a step with its number and its speed, m/s.
OnStep = Callable[[int, float], None]


@dataclass
class Robot:
    """A robot that can be run; open one with `Robot.open`.

    Attributes:
        description: What robot it is.
        backend: Its guarded backend.
        twin: Its twin, where it is one.
        predictor: Plays rollouts of it.
        period: Period of the control loop, s.
        noise: Noise of the start pose, degrees.
        seed: Seed of everything random.
        paced: Simulated time is held back to real time.
        loop: Report of the last run.
        watch: Called with every observation, for whoever draws or logs.
        estimator: Fills in the base state from the sensors; None where it is the twin's truth.
    """

    description: RobotDescription
    backend: GuardedBackend
    twin: Twin
    predictor: RolloutPredictor
    period: float
    noise: float = 0.0
    seed: int = 0
    paced: bool = False
    loop: LoopReport = field(default_factory=LoopReport)
    watch: Watch | None = None
    estimator: Estimator | None = None

    @classmethod
    def open(
        cls,
        name: str,
        *,
        rate: float | None = None,
        realtime: bool = False,
        seed: int = 0,
        noise: float = 0.0,
        delay: float | None = None,
        state: State = "true",
    ) -> Self:
        """Return a robot, connected and configured. Nothing moves.

        Args:
            name: Name of a robot, or path of a folder with one.
            rate: Rate of the loop, Hz; the robot's own by default.
            realtime: Let simulated time pass no faster than real time.
            seed: Seed of everything random.
            noise: Standard deviation of noise on the start pose, degrees.
            delay: Delay of the servos, s; the robot's own by default.
            state: Where the base state comes from: the twin's truth, or an estimate from sensors
                with the errors of real ones.

        Raises:
            WindupError: The robot's files or these options cannot be.
        """
        description = load_robot(name)
        steps = description.physics_steps(rate)
        _check_delay(delay, description)
        twin = Twin(description, delay=delay)
        true = state == "true"
        errors = None if true else ImuErrors(OPENCR, twin.timestep, seed)
        backend = GuardedBackend(
            TwinBackend(twin, paced=realtime, true_base=true, imu_errors=errors),
            SafetyLimits.of(description.joints),
            description.stop,
            description.crouch,
        )
        backend.connect()
        backend.configure()
        sensed = None if delay is None else delay + description.drive.sensor_delay
        return cls(
            description=description,
            backend=backend,
            twin=twin,
            predictor=RolloutPredictor(description, delay=sensed),
            period=steps * description.timestep,
            noise=noise,
            seed=seed,
            paced=realtime,
            estimator=None if true else build_estimator(description),
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.backend.disconnect()

    @property
    def fallen(self) -> bool:
        """True when the robot has fallen."""
        return self.twin.fallen

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

    def stand(self, seconds: float = 2.0) -> LoopReport:
        """Hold the stance for `seconds` s of the robot's time."""
        return self.run(PoseHolder(self.description.joints, self.description.stance), seconds)

    def play(self, graph: str, seconds: float | None = None) -> LoopReport:
        """Play a pose graph of the robot to its end, or for `seconds` s."""
        gait = find_gait(self.description, graph)
        player = GraphPlayer(gait, self.description.joints, self.description.contacts)
        self.start_at(gait.file.start)
        return self.run(player, seconds, until=lambda _: "done" if player.finished else None)

    def walk(
        self,
        speed: float | None = None,
        steps: int = 40,
        options: WalkOptions | None = None,
        on_step: OnStep | None = None,
    ) -> WalkReport:
        """Walk a number of steps and return how it went.

        Args:
            speed: m/s; the gait's default if None.
            steps: How many.
            options: Everything else; `speed` wins.
            on_step: Called at the end of each step with its number and its speed, m/s.

        Raises:
            UsageError: The options do not fit the gait; nothing has moved.
        """
        if steps < 1:
            raise UsageError(f"--steps {steps}: give 1 or more")
        options = options or WalkOptions()
        if speed is not None:
            options = replace(options, speed=speed)
        self.predictor.stopwatch = Stopwatch()
        walker = build_walk(self.description, options, self.predictor)
        self.start_at(walker.gait.file.start)
        report = WalkReport(self, walker, options, steps)
        try:
            self.run(walker, until=_walk_end(walker, steps, on_step), rollouts=True)
        except KeyboardInterrupt:
            self.loop.reason = "interrupted"
            self.backend.stop()
        return report

    def run(
        self,
        controller: Controller,
        seconds: float | None = None,
        *,
        until: Until | None = None,
        rollouts: bool = False,
    ) -> LoopReport:
        """Run a controller until the time is over, `until` gives a reason, or the robot falls.

        Raises:
            WindupError: From the guard, the backend or the controller; the stop policy has run.
        """
        begin = self.backend.clock.now()

        def end(observation: Observation) -> str | None:
            if self.watch is not None:
                self.watch(observation)
            if self.fallen:
                return "fell"
            if until is not None and (reason := until(observation)) is not None:
                return reason
            over = seconds is not None and observation.time >= begin + seconds - 1e-9
            return "done" if over else None

        self.loop = LoopReport()
        try:
            run_loop(
                self.backend,
                controller,
                period=self.period,
                until=end,
                estimator=self.estimator,
                rollouts=self.predictor.stopwatch if rollouts else None,
                report=self.loop,
            )
        except WindupError as error:
            self.loop.reason = str(error)
            if error.exit_status != 2:
                self._stop_after_error()
            raise
        return self.loop

    def _stop_after_error(self) -> None:
        """Carry out the stop policy; a twin that has diverged can no longer do it."""
        try:
            self.backend.stop()
        except WindupError as error:
            self.loop.reason += f"; and the stop failed: {error}"

    def start_at(self, name: str | None) -> None:
        """Put a fresh twin into a start pose, with noise; let anything else move there."""
        poses = self.description.poses
        if name is not None and name not in poses:
            raise UnknownNameError(f"pose of {self.description.name}", name, poses)
        pose = self.description.stance if name is None else poses[name]
        if self.twin.time == 0.0:
            self.twin.reset(pose, noise=self.noise, seed=self.seed)
        else:
            self.run(PoseHolder(self.description.joints, pose), START_SECONDS)


def _walk_end(walker: Balancer, steps: int, on_step: OnStep | None) -> Until:
    """Return what ends a walk: enough steps."""
    seen = 0

    def until(observation: Observation) -> str | None:
        nonlocal seen
        if on_step is not None and walker.steps > seen:
            seen = walker.steps
            on_step(seen, walker.records[-1].speed)
        return "done" if walker.steps >= steps else None

    return until


def _check_delay(delay: float | None, robot: RobotDescription) -> None:
    if delay is None:
        return
    if delay < 0.0:
        raise UsageError(f"--delay {delay:g}: give 0 s or more")
    steps = delay / robot.timestep
    if abs(steps - round(steps)) > 1e-6:
        raise UsageError(
            f"--delay {delay:g}: give a whole number of physics steps of {robot.timestep:g} s"
        )
