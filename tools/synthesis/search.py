"""The search: CMA-ES proposes gaits, they are walked, and their costs are returned to it."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from windup.hal.errors import UsageError
from windup.hal.joints import Array
from windup.tools.synthesis.genes import Gene, shape
from windup.tools.synthesis.log import Entry, SearchLog

Values = dict[str, float]
# Walks gaits, given by number and gene values, and yields the result of each.
Walker = Callable[[list[tuple[int, Values]]], Iterator[tuple[int, Entry]]]


@dataclass
class Search:
    """A search over genes.

    Hansen 2016, "The CMA evolution strategy: a tutorial". Every gene is scaled by its spread.
    Trial 0 is the unchanged gait file.

    Attributes:
        genes: The genes that may change.
        log: The trials, including those of an earlier run.
        walk: Walks gaits.
        trials: Smallest number of trials; the last generation is always completed.
        seed: Seed of the optimiser.
        population: Number of trials per generation; by default CMA-ES's for so many genes.
        spread: Scale of all spreads.
    """

    genes: list[Gene]
    log: SearchLog
    walk: Walker
    trials: int
    seed: int
    population: int | None = None
    spread: float = 1.0
    _next: int = field(default=0, init=False)

    def run(self) -> None:
        """Search until the number of trials is reached, or CMA-ES stops.

        Raises:
            UsageError: cma is not installed.
        """
        strategy = self._strategy()
        start, *_ = shape(self.genes)
        self._costs([start])
        while self._next < self.trials and not strategy.stop():
            candidates = strategy.ask()
            strategy.tell(candidates, self._costs(candidates))

    def values(self, number: int) -> Values:
        """Return the gene values of a trial."""
        kept: Values = self.log.entries[number]["values"]
        return kept

    def ranking(self) -> list[int]:
        """Return the numbers of the trials, from best to worst."""
        entries = self.log.entries
        return sorted(entries, key=lambda number: (entries[number]["cost"], number))

    def _costs(self, candidates: list[Array]) -> list[float]:
        """Return the costs of a generation; trials in the log are not walked again."""
        numbers = range(self._next, self._next + len(candidates))
        self._next += len(candidates)
        todo = [
            (number, self._express(candidate))
            for number, candidate in zip(numbers, candidates, strict=True)
            if number not in self.log.entries
        ]
        given = dict(todo)
        for number, entry in self.walk(todo):
            self.log.add(number, {"values": given[number], **entry})
        return [float(self.log.entries[number]["cost"]) for number in numbers]

    def _express(self, candidate: Array) -> Values:
        return {
            gene.name: gene.round(gene.value + gene.spread * x)
            for gene, x in zip(self.genes, candidate, strict=True)
        }

    def _strategy(self) -> Any:
        try:
            import cma
        except ImportError:
            raise UsageError(
                "synthesis needs cma and tomli-w: pip install 'windup-robotics[synthesis]'"
            ) from None
        start, lower, upper = shape(self.genes)
        random = np.random.default_rng(self.seed)
        options: dict[str, Any] = {
            "bounds": [_finite(lower), _finite(upper)],
            "randn": lambda *size: random.standard_normal(size),
            "seed": float("nan"),  # cma must not seed NumPy: `randn` is its only generator
            "verbose": -9,
        }
        if self.population is not None:
            options["popsize"] = self.population
        return cma.CMAEvolutionStrategy(start, self.spread, options)


def _finite(bounds: Array) -> list[float | None]:
    return [float(bound) if np.isfinite(bound) else None for bound in bounds]
