"""The standard motions of a robot: stand, play a pose graph, walk. `open_robot` opens it."""

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from importlib import import_module
from typing import Final

from windup.control.loop import Until
from windup.control.motions.play import GraphPlayer, PoseHolder
from windup.control.motions.staged import StagedPlayer
from windup.control.steering.guide import Guide
from windup.hal.controller import Stopwatch
from windup.hal.errors import UnknownNameError
from windup.hal.joints import Array
from windup.hal.observation import Observation
from windup.hal.ranges import check_numbers, numbers_checked
from windup.robots import load_robot
from windup.robots.inspection.doubt_once import doubt_once
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
from windup.tools.planning.plan_process import ProcessPlanner, plan_aside
from windup.tools.reports.play_report import PlayReport
from windup.tools.reports.run_report import RunReport
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
"""Modules that only some runs use, imported here so that no run of an armed robot waits."""
START_SECONDS = 1.0
PLAY_SECONDS = 5.0

Disturb = Callable[[], None]
"""Arranges pushes on a twin."""


@dataclass(eq=False)
class Motions:
    """The standard motions of a robot; see the methods of `Robot` with the same names.

    Attributes:
        session: The session of the robot.
        predictor: Simulates rollouts of it.
        noise: Noise of the start pose, degrees.
        seed: Seed of everything random.
    """

    session: Session
    predictor: RolloutPredictor
    noise: float = 0.0
    seed: int = 0

    @numbers_checked
    def stand(self, seconds: Seconds) -> RunReport:
        """Hold the stance for `seconds` s of the robot's time."""
        robot = self.session.description
        return self.session.run(PoseHolder(robot.joints, robot.stance), seconds)

    @numbers_checked
    def play(self, graph: str, seconds: Seconds | None, disturb: Disturb | None) -> PlayReport:
        """Play a pose graph; see `Robot.play`."""
        robot = self.session.description
        gait = find_gait(robot, graph)
        if seconds is None and gait.graph.periodic:
            seconds = PLAY_SECONDS
        kind = StagedPlayer if gait.file.staged else GraphPlayer
        player: StagedPlayer | GraphPlayer = kind(gait, robot.joints, robot.contacts)
        report = PlayReport(player=player, load=LoadGauge(robot.joints))
        if gait.file.lying is None:
            self.start_at(gait.file.start, needs_imu=gait.file.attitude)
        if disturb is not None:
            disturb()

        def until(observation: Observation) -> str | None:
            report.load.update(observation)
            return "done" if player.finished else player.failed

        down = gait.file.down or gait.file.lying is not None
        self.session.run(
            player, seconds, until=until, down=down, needs_imu=gait.file.attitude, report=report
        )
        return report

    @numbers_checked
    def walk(
        self,
        speed: Speed | None,
        steps: Count,
        options: WalkOptions | None,
        on_step: Sequence[OnStep],
        disturb: Disturb | None,
        stand: Seconds,
        guide: Guide | None,
    ) -> WalkReport:
        """Walk a number of steps; see `Robot.walk`."""
        session, robot = self.session, self.session.description
        options = options or WalkOptions()
        check_numbers(options)
        if speed is not None:
            options = replace(options, speed=speed)
        self.predictor.stopwatch = Stopwatch()
        # A plan takes its time on a robot; an emulated one waits for it as long.
        wait = robot.model_latency if session.stack.wired else 0.0
        walker = build_walk(robot, options, self.predictor, latency=wait)
        if guide is not None:
            walker.steering.guide = guide
        supervisor = supervisor_for(robot, walker, options, session.stack.delay)
        end = WalkEnd(walker, steps, on_step, rest=stand > 0.0)
        report = WalkReport(
            session, walker, options, steps, self.predictor.stopwatch, self.seed,
            Gauges(robot.contacts), supervisor=supervisor,
        )  # fmt: skip
        with ExitStack() as stack:
            try:
                if session.paced and walker.planner is not None:
                    period = (supervisor and supervisor.period) or session.period
                    aside = plan_aside(robot, options, self.predictor, period)
                    walker.planner = self._when_ready(stack.enter_context(aside))
                self._walk(report, end, disturb, stand)
            except RunInterruptedError as stopped:
                report.loop = session.loop
                stopped.report = report
                raise
            finally:
                session.slowness.count_plans(walker.begun, walker.late, options.model == "library")
        report.loop = session.loop
        report.note_place()
        return report

    def _walk(self, report: WalkReport, end: Until, disturb: Disturb | None, stand: float) -> None:
        """Go to the start pose, walk until the end, and stand for so long, s."""
        session, walker = self.session, report.walker
        self.start_at(walker.gait.file.start, needs_imu=True)
        report.feet = self._feet()
        if disturb is not None:
            disturb()
        report.begin()
        walked = session.run(
            report.supervisor or walker,
            until=self._looking(end, report),
            rollouts=None if session.paced else self.predictor.stopwatch,
            needs_imu=True,
        )
        if stand > 0.0 and walked.reason == "done":
            stood = self.stand(stand)
            walked.reason, walked.fallen = stood.reason, stood.fallen
            session.loop = walked

    def _when_ready(self, planner: ProcessPlanner) -> ProcessPlanner:
        """Wait for a planner; meanwhile joints hold what they were told last, or where they are."""
        session = self.session
        if session.armed or session.break_off is not None:
            last = session.backend.last
            pose = session.backend.read().joints.position if last is None else last[1].position
            holder = PoseHolder(session.description.joints, pose, ramp=0.0)
            session.run(holder, until=lambda _: "ready" if planner.ready() else None)
        return planner.wait_ready()

    def _feet(self) -> FootClearance | None:
        """Return what measures how close the feet of a twin come from now on."""
        twin = self.session.stack.twin
        if twin is None:
            return None
        return FootClearance(self.session.description, twin.model, twin.data)

    def _looking(self, end: Until, report: WalkReport) -> Until:
        """Return `end`, with a look at place, feet and plans first."""

        def until(observation: Observation) -> str | None:
            report.update(observation)
            return end(observation)

        return until

    def start_at(self, name: str | None, *, needs_imu: bool) -> None:
        """Put a fresh twin into a start pose, with noise; let anything else move there."""
        robot = self.session.description
        if name is not None and name not in robot.poses:
            raise UnknownNameError(f"pose of {robot.name}", name, robot.poses)
        self.start_in(robot.stance if name is None else robot.poses[name], needs_imu=needs_imu)

    def start_in(self, pose: Array, *, needs_imu: bool) -> None:
        """Put a fresh twin into a pose (n,) rad, with noise; let anything else move there."""
        session = self.session
        if not session.stack.wired and session.twin.time == 0.0:
            session.twin.reset(pose, noise=self.noise, seed=self.seed)
        else:
            holder = PoseHolder(session.description.joints, pose)
            session.run(holder, START_SECONDS, needs_imu=needs_imu)


@numbers_checked
def open_robot(
    name: str,
    *,
    port: str | None,
    arm: bool,
    state: State | None,
    rate: Rate | None,
    realtime: bool,
    seed: Seed,
    noise: Noise,
    delay: Delay | None,
    world: Environment | None,
    known_ground: bool,
    protect: bool,
    record: bool,
) -> Motions:
    """Return the motions of a robot, connected and configured; see `Robot.open`.

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
    session = Session(
        description=description,
        stack=stack,
        period=steps * description.timestep,
        paced=realtime or stack.twin is None or isinstance(stack.backend.clock, RealClock),
        protect=protect,
        record=record,
    )
    predictor = RolloutPredictor(description, delay=stack.delay, ground=ground)
    return Motions(session, predictor, noise, seed)
