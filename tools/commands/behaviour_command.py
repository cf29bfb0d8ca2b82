"""The one runner of behaviours: each seed on a robot of its own, one report, text and JSON."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, suppress
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, ClassVar

from windup.hal.errors import UsageError
from windup.robots import load_robot
from windup.tools.behaviours.behaviour import Behaviour
from windup.tools.behaviours.report import Report
from windup.tools.behaviours.run_record import RunRecord
from windup.tools.options.common import Common
from windup.tools.options.twin_options import WorldOptions
from windup.tools.remote.plain_options import check_alone, options_as_data
from windup.tools.remote.remote_run import run_remotely
from windup.tools.robot.port_urls import NOT_ARMED, TWIN
from windup.tools.robot.robot import Robot
from windup.tools.robot.stopping import INTERRUPTED
from windup.tools.terminal.output import console, write_json
from windup.tools.terminal.parallel import run_parallel
from windup.tools.terminal.picture import check_picture
from windup.tools.terminal.run_bar import RunBar
from windup.tools.terminal.run_notes import NOTES

Hook = Callable[[Robot], AbstractContextManager[Any]]
"""Entered with the open robot and left before it is closed: a log or a view of a run."""


@dataclass(frozen=True, kw_only=True)
class BehaviourCommand(WorldOptions, Common):
    """A command that runs a behaviour. Its options are those of the behaviour, too."""

    behaviour: ClassVar[Behaviour[Any]]
    up: bool = False
    """Do it on the robot that `windup up` has brought up; --arm then allows torque after a stop."""

    @property
    def remote(self) -> bool:
        """Does a runtime have the robot?"""
        return self.up

    @property
    def remote_name(self) -> str:
        """What a runtime knows the behaviour by."""
        return self.behaviour.name

    @property
    def options(self) -> Any:
        """The options of the behaviour, without those of the command."""
        kind = self.behaviour.Options
        return kind(**{item.name: getattr(self, item.name) for item in fields(kind) if item.init})

    @property
    def picture(self) -> Path | None:
        """The file of the picture, or None."""
        return getattr(self, "plot", None) if self.behaviour.plots else None

    def disturb(self) -> Callable[[Robot], None] | None:
        """Return what arranges pushes on a twin; None without any."""
        return None

    def hooks(self) -> Sequence[Hook]:
        """Return the logs and views of each run."""
        return ()

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        if self.up:
            check_alone(self, self.behaviour.Options)
        check_picture(self.picture)
        if self.picture is not None and self.seeds is not None:
            one = self.behaviour.name
            raise UsageError(f"--plot draws one {one}: leave it or --seeds away")
        self.behaviour.check(load_robot(self.robot), self.options)
        if self.port is not None and not (self.up or self.arm or self.port.startswith(TWIN)):
            raise UsageError(NOT_ARMED)  # before anything is written, settings too

    def run(self) -> int:
        """Run every seed; returns the exit status."""
        if self.up:
            return self._run_remotely()
        reports = list(self._reports())
        if not reports:
            raise KeyboardInterrupt
        result = reports[0].result
        if self.seeds is not None:
            summary = self.behaviour.sum_up(reports)
            console.print(summary.text, markup=False, soft_wrap=True)
            rows = [report.result for report in reports]
            result = {"robot": self.robot, "rows": rows, **summary.result}
        write_json(self.json, type(self).__name__.lower(), result)
        if len(reports) < len(self.all_seeds) or reports[-1].reason == INTERRUPTED:
            return 130
        return 0 if all(report.good for report in reports) else 1

    def _run_remotely(self) -> int:
        """Run once on the robot that is up; return the exit status."""
        name, data = load_robot(self.robot).name, options_as_data(self.options)
        return run_remotely(name, self.remote_name, data, arm=self.arm, json=self.json)

    def _reports(self) -> Iterator[Report]:
        """Run every seed until somebody interrupts; yield the reports in the order of the seeds."""
        if self.seeds is not None and self.behaviour.run_parallel:
            yield from self._side_by_side()
            return
        for seed in self.all_seeds:
            report = self.one(seed)
            yield report
            if report.reason == INTERRUPTED:
                return

    def one(self, seed: int, *, show: bool = True) -> Report:
        """Run one seed and return how it went; also `show` that, and draw what is to be drawn."""
        with self.open_behaving(seed) as robot:
            run = RunRecord(robot, self.options, self.disturb(), self.seeds is None, self.picture)
            report = self._performed(run)
        if show:
            for line in report.lines:
                console.print(line, markup=False, soft_wrap=True)
        if show and run.alone:
            self.keep(run)
        return report

    def open_behaving(self, seed: int) -> Robot:
        """Return the robot, opened as the behaviour wants it.

        Raises:
            WindupError: The robot's files, the options, or the bus cannot be.
        """
        description = load_robot(self.robot)
        more = self.behaviour.opening(description, self.options)
        made_for = more.pop("rate", None)
        rate = self.rate or made_for
        world = self.world(description, seed)
        return replace(self, rate=rate).open_robot(seed, world=world, **more)

    def _performed(self, run: RunRecord[Any]) -> Report:
        """Run the behaviour on an open robot, with its logs and views, and return its report."""
        interrupted = False
        with ExitStack() as stack:
            for hook in self.hooks():
                stack.enter_context(hook(run.robot))
            show = run.alone and not run.robot.paced
            run.progress = stack.enter_context(RunBar(type(self).__name__.lower(), show))
            try:
                self.behaviour.perform(run)
            except KeyboardInterrupt:  # the robot has stopped; the report says how far it came
                if run.measured is None:
                    raise
                interrupted = True
        report = self.behaviour.report(run)
        return report.interrupted() if interrupted else report

    def keep(self, run: RunRecord[Any]) -> None:
        """Write what a run gives beside its report."""
        if run.plot is not None:
            with NOTES.collecting_output_errors():
                self.behaviour.draw(run.plot, run)
                console.print(f"picture: {run.plot}", markup=False, soft_wrap=True)

    def _side_by_side(self) -> Iterator[Report]:
        """Run the seeds in a process each; yield their reports, which have their warnings."""
        seeds = self.all_seeds
        self._check_opened(seeds[0])
        done: dict[int, Report] = {}
        with suppress(KeyboardInterrupt):
            done.update(run_parallel(self._noted, seeds, label="seeds"))
        for seed in sorted(done):
            NOTES.add_row(done[seed].result)
            yield done[seed]

    def _check_opened(self, seed: int) -> None:
        """Raise what is wrong with the options before any process is started."""
        with self.open_behaving(seed) as robot:
            self.behaviour.build(robot.description, self.options, robot.predictor)

    def _noted(self, seed: int) -> Report:
        """Run one seed in a process of its own; its result has its warnings."""
        NOTES.begin()
        report = self.one(seed, show=False)
        noted = {"warnings": NOTES.records(), "driver_clamps": NOTES.driver_clamps}
        return replace(report, result=report.result | noted)
