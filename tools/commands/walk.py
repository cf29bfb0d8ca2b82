"""`windup walk`: walk a robot under limit-cycle balance."""

from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from os import cpu_count
from pathlib import Path
from typing import Any, Literal

import numpy as np
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from windup.control.pose_graph.gait_file import Sampling
from windup.hal.errors import UsageError
from windup.hal.geometry.up_axis import uprightness
from windup.robots import load_robot
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.catching import supervisor_for
from windup.tools.assembly.stepping import find_stepping
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.command_line.typed import as_typed
from windup.tools.commands.plot import Trace, plot_walk
from windup.tools.measures.walk_text import format_summary
from windup.tools.options.common import Common
from windup.tools.options.twin_options import TwinOptions
from windup.tools.robot.learnt_file import check_learning, keep_learnt
from windup.tools.robot.robot import Robot
from windup.tools.robot.walk_report import WalkReport, summary
from windup.tools.stopping.interrupts import RunInterruptedError
from windup.tools.terminal.output import console, write_json
from windup.tools.terminal.picture import check_picture
from windup.tools.terminal.quantities import Count, Delay, Metres, Seconds, Speed, TurnRate
from windup.tools.terminal.run_notes import NOTES

STEPS = 80
GOAL_STEPS = 1000


@dataclass(frozen=True, kw_only=True)
class Walk(TwinOptions, Common):
    """Walk a robot and say how it went."""

    steps: Count | None = None
    """How many steps to walk, 80 by default; or in how many to reach a goal, 1000 by default."""
    speed: Speed | None = None
    """Speed, m/s; the gait's default otherwise."""
    side: Speed = 0.0
    """Sideways speed, m/s; positive to the left."""
    turn: TurnRate = 0.0
    """Turn rate, degrees/s; positive to the left."""
    path: str | None = None
    """Follow a path: a CSV file of x,y waypoints, circle:RADIUS or square:SIDE, m."""
    to: tuple[Metres, Metres] | None = None
    """Walk to the point X Y, m, and stop."""
    known_ground: bool = False
    """Let the rollouts know the ground."""
    stand: Seconds = 0.0
    """Afterwards come to rest and stand for some seconds."""
    style: tuple[str, ...] = ()
    """Styles and how much of them, NAME=AMOUNT; any perturbation of the gait is one too. With
    NAME=AMOUNT@BEGIN:END it comes and goes, s."""
    blend: tuple[str, ...] = ()
    """Gaits to blend into this one and how far, GAIT=AMOUNT, also with @BEGIN:END; at 1 the poses,
    times and targets are all theirs."""
    gait: str = "walk"
    """Name of the gait, or the path of a gait file of your own."""
    rv: tuple[str, ...] | None = None
    """Regulation variables, such as: up, or up.forward swing_com.lateral."""
    sampling: Sampling | None = None
    """How the step model is sampled."""
    model: Literal["full", "frozen", "library"] = "full"
    """Sample the step model every step, or only when regulation drifts (frozen), or look it up by
    the start of the step (library): one rollout then does. See --learn."""
    learn: Path | None = None
    """Add the step models of this walk to a file: GAIT.models.json beside the gait is the library
    of `--model library`, and every step then takes one rollout."""
    target: tuple[str, ...] = ()
    """Targets of the regulation variables: VALUE for the first forward one, or NAME=VALUE."""
    torso_servo: bool = True
    """Keep the torso upright by its own servo, where the gait has one."""
    catch: bool = False
    """Let the stepper catch pushes that the walk cannot absorb: it steps, halts, and walks on."""
    open_loop: bool = False
    """Play the bare pose graph, without balance."""
    delay: Delay | None = None
    """Delay of the servos, s."""
    plot: Path | None = None
    """Draw the walk into an image file: path, regulation variables, feet on the ground."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        options = self._options()
        check_learning(options, alone=self.seeds is None and not self.realtime)
        check_picture(self.plot)
        if self.plot is not None and self.seeds is not None:
            raise UsageError("--plot draws one walk: leave it or --seeds away")
        robot = load_robot(self.robot)
        supervisor_for(robot, build_walk(robot, options, None), options.catch, 0.0)

    def run(self) -> int:
        """Walk; returns the exit status."""
        seeds = self.all_seeds
        if len(seeds) == 1 and self.seeds is None:
            result = self._one(seeds[0], show=True)
            ok = result["reason"] == "done"
            write_json(self.json, "walk", result)
            return 130 if result["reason"] == "interrupted" else 0 if ok else 1
        rows = list(self._many(seeds))
        whole = summary(rows)
        console.print(format_summary(whole))
        write_json(self.json, "walk", {"robot": self.robot, "rows": rows, "summary": whole})
        return 0 if whole["walked"] == whole["runs"] else 1

    def _one(self, seed: int, *, show: bool) -> dict[str, Any]:
        """Walk one seed and return its result."""
        rate = self.rate or (find_stepping(load_robot(self.robot)).rate if self.catch else None)
        with replace(self, rate=rate).open_robot(
            seed,
            delay=self.delay,
            world=self.world(load_robot(self.robot), seed),
            known_ground=self.known_ground,
        ) as robot:
            trace = Trace(robot.description.contacts)
            if self.plot and show:
                robot.watch.append(trace.add)
            with _progress(show and not self.realtime) as progress:
                report = self._walk(robot, progress)
        if show:
            console.print(str(report), markup=False, soft_wrap=True)
        if self.learn is not None:
            with NOTES.losing():
                keep_learnt(self.learn, report, as_typed(self, ("learn", "json", "plot")))
        if self.plot is not None and show:
            with NOTES.losing():
                plot_walk(self.plot, report, trace)
                console.print(f"picture: {self.plot}", markup=False, soft_wrap=True)
        return report.result()

    @property
    def _most(self) -> int:
        """Steps to walk, or to reach the goal in."""
        if self.steps is not None:
            return self.steps
        return STEPS if self.path is None and self.to is None else GOAL_STEPS

    def _walk(self, robot: Robot, progress: Progress) -> WalkReport:
        bar = progress.add_task("walking", total=self._most, speed="", lean="")
        try:
            return robot.walk(
                steps=self._most,
                options=self._options(),
                on_step=[_update(progress, bar, robot)],
                disturb=self.disturb(),
                stand=self.stand,
            )
        except RunInterruptedError as stopped:
            walked: WalkReport = stopped.report
            return walked

    def _options(self) -> WalkOptions:
        return WalkOptions(
            gait=self.gait,
            speed=self.speed,
            side=self.side,
            turn=self.turn,
            style=self.style,
            blend=self.blend,
            path=self.path,
            to=self.to,
            rv=self.rv,
            sampling=self.sampling,
            model=self.model,
            learn=self.learn,
            target=self.target,
            torso_servo=self.torso_servo,
            open_loop=self.open_loop,
            catch=find_stepping(load_robot(self.robot)).way if self.catch else None,
        )

    def _many(self, seeds: list[int]) -> Iterator[dict[str, Any]]:
        """Walk several seeds side by side, one process a core."""
        self._check()
        with _progress(True) as progress:
            bar = progress.add_task("seeds", total=len(seeds), speed="", lean="")
            with ProcessPoolExecutor(max_workers=min(len(seeds), cpu_count() or 1)) as pool:
                for row in pool.map(self._quietly, seeds):
                    progress.advance(bar)
                    NOTES.add_row(row)
                    yield row

    def _check(self) -> None:
        """Raise what is wrong with the options before any process is started."""
        self.world(load_robot(self.robot), 0)
        with Robot.open(self.robot, rate=self.rate, delay=self.delay) as robot:
            build_walk(robot.description, self._options(), robot.predictor)

    def _quietly(self, seed: int) -> dict[str, Any]:
        """Walk one seed in a process of its own, and return its result with its warnings."""
        NOTES.begin()
        row = self._one(seed, show=False)
        return row | {"warnings": NOTES.records(), "driver_clamps": NOTES.driver_clamps}


def _progress(show: bool) -> Progress:
    """Return a progress bar; it draws from a thread, so a loop on the wall's time has none."""
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[speed]} {task.fields[lean]}"),
        console=console,
        transient=True,
        disable=not (show and console.is_terminal),
    )


def _update(progress: Progress, bar: Any, robot: Robot) -> Callable[[int, float], None]:
    """Return what moves the progress bar at the end of a step."""

    def update(steps: int, speed: float) -> None:
        assert robot.base is not None, "a walk has a base state"
        _, x, y, _ = robot.base.orientation
        lean = np.degrees(np.arccos(np.clip(uprightness(x, y), -1.0, 1.0)))
        progress.update(
            bar, completed=steps, speed=f"{speed:5.2f} m/s", lean=f"lean {lean:4.1f} deg"
        )

    return update
