"""`Robot`: a stack of backend, guard, estimator and loop; the only place where one is put together.

with Robot.open("op3") as robot:              # its twin
    report = robot.walk(speed=0.2, steps=40)
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from types import TracebackType
from typing import Self

import numpy as np

from control.loop import LoopReport, Until, run_loop
from control.play import GraphPlayer, PoseHolder
from hal.controller import Controller, Stopwatch
from hal.errors import HardwareError, UnknownNameError, UsageError, WindupError
from hal.guard import GuardedBackend
from hal.observation import BaseState, Observation
from robots import RobotDescription, load_robot
from sim_twin.clearance import FootClearance
from sim_twin.push import Push
from sim_twin.rollouts import RolloutPredictor
from sim_twin.twin import Twin
from sim_twin.world import World
from tools.build import WalkOptions, build_walk, find_gait
from tools.report import WalkReport
from tools.stack import Stack, State, twin_stack, wire_stack
from tools.walk_end import OnStep, WalkEnd

START_SECONDS = 1.0
REST_SECONDS = 1.5
# Called once a tick with the observation and the controller.
Watch = Callable[[Observation], None]


@dataclass
class Robot:
    """A robot that can be run; open one with `Robot.open`.

    Attributes:
        description: What robot it is.
        stack: Its backend and what belongs to it.
        predictor: Plays rollouts of it.
        period: Period of the control loop, s.
        noise: Noise of the start pose, degrees.
        seed: Seed of everything random.
        paced: Its time is real time.
        loop: Report of the last run.
        watch: Called with every observation, for whoever draws or logs.
        base: Base state last seen: the truth on a twin, an estimate on a robot.
        clearance: How close the feet of a twin came in the last walk.
    """

    description: RobotDescription
    stack: Stack
    predictor: RolloutPredictor
    period: float
    noise: float = 0.0
    seed: int = 0
    paced: bool = False
    loop: LoopReport = field(default_factory=LoopReport)
    watch: Watch | None = None
    base: BaseState | None = None
    clearance: FootClearance | None = None
    _armed: bool = False

    @classmethod
    def open(
        cls,
        name: str,
        *,
        port: str | None = None,
        arm: bool = False,
        state: State | None = None,
        rate: float | None = None,
        realtime: bool = False,
        seed: int = 0,
        noise: float = 0.0,
        delay: float | None = None,
        world: World | None = None,
        known_ground: bool = False,
    ) -> Self:
        """Return a robot, connected and configured. Nothing moves.

        Args:
            name: Name of a robot, or path of a folder with one.
            port: URL of its servo bus, or "BUS=URL,BUS=URL"; without one, its twin.
            arm: Allow torque on a port that is not twin://.
            state: Where the base state comes from; on a port it is estimated, else the truth.
            rate: Rate of the loop, Hz; the robot's own by default.
            realtime: Let simulated time pass no faster than real time.
            seed: Seed of everything random.
            noise: Standard deviation of noise on the start pose, degrees.
            delay: Delay of the servos, s; the robot's own by default.
            world: The twin's ground and how its plant differs; the controller does not know.
            known_ground: The rollouts know the ground.

        Raises:
            WindupError: The robot's files, these options, or the bus cannot be.
        """
        description = load_robot(name)
        wired = description.wire_rate_hz if port is not None else None
        steps = description.physics_steps(rate or wired)
        if port is None:
            stack = twin_stack(
                description, state=state or "true", paced=realtime, delay=delay, world=world
            )
        elif world is not None:
            raise UsageError("only a twin has another ground or plant; leave --port away")
        else:
            stack = wire_stack(
                description, port, state=state or "estimated", arm=arm, noise=noise, seed=seed
            )
        return cls(
            description=description,
            stack=stack,
            predictor=RolloutPredictor(
                description,
                delay=stack.delay,
                ground=world.ground if world is not None and known_ground else None,
            ),
            period=steps * description.timestep,
            noise=noise,
            seed=seed,
            paced=realtime or stack.twin is None,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            if self._armed and error is None and not self.fallen:
                self.rest()
            elif self._armed:
                self.stop()
        finally:
            self.stack.close()

    @property
    def backend(self) -> GuardedBackend:
        """The guarded backend."""
        return self.stack.backend

    @property
    def twin(self) -> Twin:
        """The twin behind the backend.

        Raises:
            UsageError: This is a robot, not a twin.
        """
        if self.stack.twin is None:
            raise UsageError("only a twin can do that; leave --port away")
        return self.stack.twin

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

    def shove(self, speed: float, direction: float = 0.0, *, delay: float = 0.0) -> None:
        """Give a whole twin `speed` m/s toward `direction` rad, `delay` s from now."""
        mass = float(self.twin.model.body_mass.sum())
        self.twin.push(Push.velocity_step(speed, mass, direction, self.twin.time + delay))

    def arm(self) -> None:
        """Switch the torque on at the present pose, where there are servos to switch.

        Raises:
            UsageError: The port is real and `arm` was not given; nothing has moved.
            HardwareError: A servo did not take it; all torque is off again.
        """
        if self._armed or not self.stack.wired:
            return
        if not self.stack.may_arm:
            raise UsageError("this moves a robot: give --arm (arm=True), and hold on to it")
        self._armed = True
        on = self.backend.set_torque(True)
        if not on.all():
            names = ", ".join(np.array(self.description.joints.names)[~on])
            raise HardwareError(f"torque does not come on at {names}; run `windup scan`")

    def rest(self) -> None:
        """Crouch, if the robot has a pose for it, and switch the torque off."""
        crouch = self.description.crouch
        if crouch is not None:
            self.run(PoseHolder(self.description.joints, crouch, REST_SECONDS), REST_SECONDS + 0.3)
        self.stop(limp=True)

    def stop(self, *, limp: bool = False) -> None:
        """Carry out the stop policy at once; with `limp`, just switch the torque off.

        Raises:
            HardwareError: Torque was told to go off and a joint read back on.
        """
        on = self.backend.stop("limp" if limp else None)
        self._armed = bool(on.any())

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
        disturb: Callable[["Robot"], None] | None = None,
        stand: float = 0.0,
    ) -> WalkReport:
        """Walk a number of steps and return how it went.

        Args:
            speed: m/s; the gait's default if None.
            steps: How many.
            options: Everything else; `speed` wins.
            on_step: Called at the end of each step with its number and its speed, m/s.
            disturb: Called before the first step, to arrange pushes on a twin.
            stand: Then come to rest and stand for so long, s.

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
        end = WalkEnd(walker, steps, on_step, rest=stand > 0.0)
        self.start_at(walker.gait.file.start)
        if (twin := self.stack.twin) is not None:
            self.clearance = FootClearance(self.description, twin.model, twin.data)
            if disturb is not None:
                disturb(self)
        report = WalkReport(self, walker, options, steps)
        try:
            self.run(walker, until=end, rollouts=True)
            if stand > 0.0 and self.loop.reason == "done":
                walked, self.loop = self.loop, self.stand(stand)
                walked.reason = self.loop.reason
                self.loop = walked
        except KeyboardInterrupt:
            self.loop.reason = "interrupted"
            self.stop()
        report.loop = self.loop
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
        self.arm()
        begin = self.backend.clock.now()

        def end(observation: Observation) -> str | None:
            self.base = observation.base
            if rollouts and self.clearance is not None:
                self.clearance.look()
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
                estimator=self.stack.estimator,
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
            self.stop()
        except WindupError as error:
            self.loop.reason += f"; and the stop failed: {error}"

    def start_at(self, name: str | None) -> None:
        """Put a fresh twin into a start pose, with noise; let anything else move there."""
        poses = self.description.poses
        if name is not None and name not in poses:
            raise UnknownNameError(f"pose of {self.description.name}", name, poses)
        pose = self.description.stance if name is None else poses[name]
        if not self.stack.wired and self.twin.time == 0.0:
            self.twin.reset(pose, noise=self.noise, seed=self.seed)
        else:
            self.run(PoseHolder(self.description.joints, pose), START_SECONDS)
