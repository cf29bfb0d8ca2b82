"""The command line of `windup synthesise`."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import msgspec
import tyro

from windup.control.pose_graph.gait_file import GaitFile
from windup.hal.config import load_toml
from windup.hal.errors import UsageError
from windup.hal.ranges import Range
from windup.robots import load_robot
from windup.tools.assembly.build import build_walk
from windup.tools.assembly.gaits import gait_path
from windup.tools.assembly.shape import check_walks
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.synthesis.gait_toml import write_gait
from windup.tools.synthesis.genes import Genome
from windup.tools.synthesis.log import Entry, SearchLog
from windup.tools.synthesis.score import Objective, objective
from windup.tools.synthesis.search import Search, Values
from windup.tools.synthesis.trial import Trial, walk_trial
from windup.tools.terminal.command import Command
from windup.tools.terminal.output import console, write_json
from windup.tools.terminal.parallel import Workers
from windup.tools.terminal.quantities import Count, Jobs, Noise, Seed, Some, Speed
from windup.tools.terminal.writing import check_writable

FINALISTS = 5
Positional = Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="ROBOT")]


@dataclass(frozen=True, kw_only=True)
class Synthesise(Command):
    """Improve a gait, or find one, with CMA-ES: `windup walk ROBOT --gait FILE` walks the result.

    Trials are stored beside the result in FILE.trials: after Ctrl-C the same command line continues
    the search, and a larger --trials extends it. In the end the best trials are walked again from
    other starts, and the best of these is written.

    windup synthesise op3 --speed 0.2 --aim 0.2 --objective falls speed effort --out thrifty.toml
    """

    robot: Positional
    """Name of a robot, or path of a folder with your own."""
    gait: str = "walk"
    """Initial gait: its name, or the path of a gait file."""
    vary: tuple[str, ...] | None = None
    """Numbers that may change, * for any: pose.STATE.JOINT, hold.STATE, target.VARIABLE,
    limit.NAME, change.NAME.JOINT. By default angles of moving joints, hold times, and targets."""
    objective: tuple[str, ...] = ()
    """Terms of the cost, TERM or TERM=WEIGHT: falls, speed, effort, shake, drift, cross,
    flight, air, skip."""
    aim: Speed | None = None
    """Desired speed for the term `speed`, m/s."""
    speed: Speed | None = None
    """Commanded speed, m/s; the gait's own by default."""
    trials: Count = 300
    """Number of gaits to try."""
    steps: Count = 40
    """Steps of each walk."""
    seeds: Some = 3
    """Number of noisy starts of each trial."""
    noise: Noise = 0.2
    """Standard deviation of noise on the start pose, degrees."""
    seed: Seed = 0
    """Seed of the search."""
    population: Annotated[int, Range(4, 10_000)] | None = None
    """Number of trials per generation."""
    spread: Annotated[float, Range(0.0, 100.0, above=True)] = 1.0
    """Scale of the first changes of the gait: 1 is 4 degrees, 0.02 s, 0.03 of a target."""
    out: Path
    """Gait file to write, .toml."""
    jobs: Jobs | None = None
    """Number of processes; one per core by default."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""

    def run(self) -> int:
        """Search; return 0 if the written gait walks from all starts, else 1."""
        robot = load_robot(self.robot)
        check_walks(robot)
        start = load_toml(gait_path(robot, self.gait), GaitFile)
        build_walk(robot, WalkOptions(gait=self.gait, speed=self.speed), None)
        genome = Genome(start, robot.joints, robot.mirror)
        genes = genome.choose(self.vary)
        aim = objective(self.objective, self.aim)
        log = SearchLog(self._log_path(), self._setup(start, [gene.name for gene in genes], aim))
        console.print(f"{len(genes)} genes, {len(log.entries)} of {self.trials} trials done before")
        with Workers("trials", total=self.trials, done=len(log.entries), jobs=self.jobs) as workers:

            def walk(todo: list[tuple[int, Values]]) -> Iterator[tuple[int, Entry]]:
                seeds = tuple(range(self.seeds))
                trials = [self._trial(n, genome.express(values), seeds) for n, values in todo]
                for trial, rows in workers.run(walk_trial, trials):
                    yield trial.number, {"cost": aim.cost(rows), "terms": aim.terms(rows)}
                    workers.set_status(f"best cost {_best(log):.3f}")

            search = Search(genes, log, walk, self.trials, self.seed, self.population, self.spread)
            search.run()
            finals = self._finals(search, genome, aim, workers)
        return self._conclude(search, genome, finals)

    def check(self) -> None:
        """Check the options; see `Command.check`."""
        super().check()
        if self.out.suffix != ".toml":
            raise UsageError(f"--out {self.out}: name it .toml")
        check_writable(self.out, self._log_path())

    def _log_path(self) -> Path:
        return self.out.with_suffix(".trials")

    def _setup(self, start: GaitFile, genes: list[str], aim: Objective) -> dict[str, Any]:
        """Return the settings that must be equal for a search to continue."""
        names = ("robot", "speed", "steps", "seeds", "noise", "seed", "population", "spread")
        options = {name: getattr(self, name) for name in names}
        told = {"objective": aim.weights, "aim": aim.aim, "vary": genes}
        return {**options, **told, "gait": msgspec.to_builtins(start)}

    def _trial(self, number: int, file: GaitFile, seeds: tuple[int, ...]) -> Trial:
        return Trial(number, self.robot, file, self.steps, self.noise, seeds, self.speed)

    def _finals(
        self, search: Search, genome: Genome, aim: Objective, workers: Workers
    ) -> dict[int, Entry]:
        """Walk the initial gait and the best ones again, from starts not used in the search."""
        seeds = tuple(range(self.seeds, 3 * self.seeds))
        numbers = list(dict.fromkeys([0, *search.ranking()[:FINALISTS]]))
        trials = [self._trial(n, genome.express(search.values(n)), seeds) for n in numbers]
        return {
            trial.number: {
                "cost": aim.cost(rows),
                "terms": aim.terms(rows),
                "walked": sum(row["reason"] == "done" for row in rows),
                "runs": len(rows),
            }
            for trial, rows in workers.run(walk_trial, trials)
        }

    def _conclude(self, search: Search, genome: Genome, finals: dict[int, Entry]) -> int:
        best = min(finals, key=lambda number: (finals[number]["cost"], number))
        before, after = finals[0], finals[best]
        file = genome.express(search.values(best))
        source = f"windup synthesise {self.robot} --gait {self.gait}, trial {best}. {file.source}"
        write_gait(self.out, msgspec.structs.replace(file, source=source.strip()))
        for name, value in after["terms"].items():
            console.print(f"{name:>8}  {before['terms'][name]:7.3f} -> {value:7.3f}", markup=False)
        console.print(
            f"cost {before['cost']:.3f} -> {after['cost']:.3f} on other starts, "
            f"{after['walked']} of {after['runs']} walked to the end: {self.out}",
            markup=False,
            soft_wrap=True,
        )
        result = {"robot": self.robot, "gait": self.gait, "out": str(self.out), "trial": best}
        told = {"before": before, "after": after, "values": search.values(best)}
        write_json(self.json, "synthesise", {**result, "seed": self.seed, **told})
        return 0 if after["walked"] == after["runs"] else 1


def _best(log: SearchLog) -> float:
    return min((entry["cost"] for entry in log.entries.values()), default=float("nan"))
