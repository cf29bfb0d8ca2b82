"""`Robot`: a stack of backend, guard, estimator and loop; the only place where one is put together.

with Robot.open("op3") as robot:              # its twin
    report = robot.walk(speed=0.2, steps=40)
"""

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from importlib import import_module
from typing import Final, Self

from windup.control.loop import LoopReport, Until
from windup.control.motions.play import GraphPlayer, PoseHolder
from windup.control.motions.staged import StagedPlayer
from windup.hal.controller import Stopwatch
from windup.hal.errors import UnknownNameError
from windup.hal.joints import Array
from windup.hal.observation import Observation
from windup.hal.ranges import check_numbers, numbers_checked
from windup.robots import load_robot
from windup.sim_twin.environment import Environment
from windup.sim_twin.ground.clearance import FootClearance
from windup.sim_twin.rollouts import RolloutPredictor
from windup.sim_twin.wire.world.clocks import RealClock
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.catching import supervisor_for
from windup.tools.assembly.gaits import find_gait
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.measures.gauges import Gauges
from windup.tools.measures.load_gauge import LoadGauge
from windup.tools.measures.walk_end import OnStep, WalkEnd
from windup.tools.robot.doubt_once import doubt_once
from windup.tools.robot.plan_process import ProcessPlanner, plan_aside
from windup.tools.robot.session import Session
from windup.tools.robot.stack import State, open_stack
from windup.tools.robot.walk_report import WalkReport
from windup.tools.stopping.interrupts import RunInterruptedError
from windup.tools.terminal.quantities import Count, Delay, Noise, Rate, Seconds, Seed, Speed

LATER: Final = (
    "windup.control.falling.protection",
    "windup.sim_twin.wire.world.worlds",
    "windup.tools.assembly.supervise",
    "windup.tools.terminal.output",
)
"""Modules that only some runs use, imported by `open` so that no run of an armed robot waits."""
START_SECONDS = 1.0
PLAY_SECONDS = 5.0


@dataclass(eq=False)
class Robot(Session):
    """A robot that can be run; open one with `Robot.open`.

    Attributes:
        predictor: Plays rollouts of it.
        noise: Noise of the start pose, degrees.
        seed: Seed of everything random.
        player: What played the last pose graph.
        load: How hard the servos worked for that.
    """

    predictor: RolloutPredictor = field(kw_only=True)
    noise: float = 0.0
    seed: int = 0
    player: GraphPlayer | StagedPlayer | None = field(default=None, init=False)
    load: LoadGauge | None = field(default=None, init=False)

    @classmethod
    @numbers_checked
    def open(
        cls,
        name: str,
        *,
        port: str | None = None,
        arm: bool = False,
        state: State | None = None,
        rate: Rate | None = None,
        realtime: bool = False,
        seed: Seed = 0,
        noise: Noise = 0.0,
        delay: Delay | None = None,
        world: Environment | None = None,
        known_ground: bool = False,
        protect: bool = True,
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
            protect: Soften falls that cannot be prevented, where the robot's file says how.

        Raises:
            WindupError: The robot's files, these options, or the bus cannot be.
        """
        for module in LATER:
            import_module(module)
        description = load_robot(name)
        doubt_once(description)
        wired = description.wire_rate_hz if port is not None else None
        steps = description.physics_steps(rate or wired)
        stack = open_stack(
            description, port, state=state, arm=arm, paced=realtime, delay=delay, noise=noise,
            seed=seed, world=world,
        )  # fmt: skip
        ground = world.ground if world is not None and known_ground else None
        return cls(
            description=description,
            stack=stack,
            predictor=RolloutPredictor(description, delay=stack.delay, ground=ground),
            period=steps * description.timestep,
            noise=noise,
            seed=seed,
            paced=realtime or stack.twin is None or isinstance(stack.backend.clock, RealClock),
            protect=protect,
        )

    @numbers_checked
    def stand(self, seconds: Seconds = 2.0) -> LoopReport:
        """Hold the stance for `seconds` s of the robot's time."""
        return self.run(PoseHolder(self.description.joints, self.description.stance), seconds)

    @numbers_checked
    def play(
        self,
        graph: str,
        seconds: Seconds | None = None,
        disturb: Callable[["Robot"], None] | None = None,
    ) -> LoopReport:
        """Play a pose graph of the robot to its end, or for `seconds` s.

        A graph without an end is played for 5 s. One that waits for the sensors in vain is given
        up, and the report's reason says why.

        Args:
            graph: Name of the graph, or the path of a file.
            seconds: How long at most.
            disturb: Called when it is in its start pose, to arrange pushes on a twin.
        """
        gait = find_gait(self.description, graph)
        if seconds is None and gait.graph.periodic:
            seconds = PLAY_SECONDS
        kind = StagedPlayer if gait.file.staged else GraphPlayer
        player = self.player = kind(gait, self.description.joints, self.description.contacts)
        if gait.file.lying is None:
            self.start_at(gait.file.start, needs_imu=gait.file.attitude)
        if disturb is not None:
            disturb(self)
        load = self.load = LoadGauge(self.description.joints)

        def until(observation: Observation) -> str | None:
            load.update(observation)
            return "done" if player.finished else player.failed

        down = gait.file.down or gait.file.lying is not None
        return self.run(player, seconds, until=until, down=down, needs_imu=gait.file.attitude)

    @numbers_checked
    def walk(
        self,
        speed: Speed | None = None,
        steps: Count = 40,
        options: WalkOptions | None = None,
        on_step: Sequence[OnStep] = (),
        disturb: Callable[["Robot"], None] | None = None,
        stand: Seconds = 0.0,
    ) -> WalkReport:
        """Walk a number of steps and return how it went.

        Args:
            speed: m/s; the gait's default if None.
            steps: How many.
            options: Everything else; `speed` wins.
            on_step: All are called at the end of each step with its number and its speed, m/s.
            disturb: Called before the first step, to arrange pushes on a twin.
            stand: Then come to rest and stand for so long, s.

        Raises:
            UsageError: The options do not fit the gait; nothing has moved.
            RunInterruptedError: By a signal; the robot has stopped, and the report is attached.
        """
        options = options or WalkOptions()
        check_numbers(options)
        if speed is not None:
            options = replace(options, speed=speed)
        self.predictor.stopwatch = Stopwatch()
        # A plan takes its time on a robot; an emulated one waits for it as long.
        wait = self.description.model_latency if self.stack.wired else 0.0
        walker = build_walk(self.description, options, self.predictor, latency=wait)
        supervisor = supervisor_for(self.description, walker, options.catch, self.stack.delay)
        end = WalkEnd(walker, steps, on_step, rest=stand > 0.0)
        report = WalkReport(
            self, walker, options, steps, self.predictor.stopwatch, self.seed,
            Gauges(self.description.contacts), supervisor=supervisor,
        )  # fmt: skip
        with ExitStack() as stack:
            try:
                if self.paced and walker.planner is not None:
                    period = (supervisor and supervisor.period) or self.period
                    aside = plan_aside(self.description, options, self.predictor, period)
                    walker.planner = self._when_ready(stack.enter_context(aside))
                self._walk(report, end, disturb, stand)
            except RunInterruptedError as stopped:
                report.loop = self.loop
                stopped.report = report
                raise
            finally:
                self.slowness.count_plans(walker.begun, walker.late, options.model == "library")
        report.loop = self.loop
        report.note_place()
        return report

    def _walk(
        self,
        report: WalkReport,
        end: Until,
        disturb: Callable[["Robot"], None] | None,
        stand: float,
    ) -> None:
        """Go to the start pose, walk until the end, and stand for so long, s."""
        walker = report.walker
        self.start_at(walker.gait.file.start, needs_imu=True)
        report.feet = self._feet()
        if disturb is not None:
            disturb(self)
        report.begin()
        walked = self.run(
            report.supervisor or walker,
            until=self._looking(end, report),
            rollouts=None if self.paced else self.predictor.stopwatch,
            needs_imu=True,
        )
        if stand > 0.0 and walked.reason == "done":
            walked.reason = self.stand(stand).reason
            self.loop = walked

    def _when_ready(self, planner: ProcessPlanner) -> ProcessPlanner:
        """Wait for a planner; meanwhile joints hold what they were told last, or where they are."""
        if self.armed:
            told = None if self.start is None else self.start.motion.goal
            pose = self.backend.read().joints.position if told is None else told
            holder = PoseHolder(self.description.joints, pose, ramp=0.0)
            self.run(holder, until=lambda _: "ready" if planner.ready() else None)
        return planner.wait_ready()

    def _feet(self) -> FootClearance | None:
        """Return what measures how close the feet of a twin come from now on."""
        twin = self.stack.twin
        return None if twin is None else FootClearance(self.description, twin.model, twin.data)

    def _looking(self, end: Until, report: WalkReport) -> Until:
        """Return `end`, with a look at place, feet and plans first."""

        def until(observation: Observation) -> str | None:
            report.update(observation)
            return end(observation)

        return until

    def start_at(self, name: str | None, *, needs_imu: bool = False) -> None:
        """Put a fresh twin into a start pose, with noise; let anything else move there."""
        poses = self.description.poses
        if name is not None and name not in poses:
            raise UnknownNameError(f"pose of {self.description.name}", name, poses)
        pose = self.description.stance if name is None else poses[name]
        self.start_in(pose, needs_imu=needs_imu)

    def start_in(self, pose: Array, *, needs_imu: bool = False) -> None:
        """Put a fresh twin into a pose (n,) rad, with noise; let anything else move there.

        What comes next may need the IMU: then this does not begin without it either.
        """
        if not self.stack.wired and self.twin.time == 0.0:
            self.twin.reset(pose, noise=self.noise, seed=self.seed)
        else:
            holder = PoseHolder(self.description.joints, pose)
            self.run(holder, START_SECONDS, needs_imu=needs_imu)
