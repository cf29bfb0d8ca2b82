"""What a figure of a paper is to us: runs, a picture, and claims that the data decide."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from windup.hal.errors import UnknownNameError

Result = dict[str, Any]


@dataclass(frozen=True)
class Job:
    """One run that figures need; equal jobs are run once.

    Attributes:
        kind: What to do; the study's `work` knows it.
        options: Plain JSON values.
    """

    kind: str
    options: Mapping[str, Any]

    def __hash__(self) -> int:
        return hash((self.kind, repr(sorted(self.options.items()))))


Results = Mapping[Job, Result]


@dataclass(frozen=True)
class Claim:
    """A statement of the paper beside ours.

    Attributes:
        theirs: What the paper says, in our words.
        ours: What our data say.
        criterion: What would agree.
        agrees: Whether they do, computed from the data; None where these are too few to tell.
        own: Not the paper's statement, but a mark that we have set ourselves.
    """

    theirs: str
    ours: str
    criterion: str
    agrees: bool | None
    own: bool = False

    @property
    def word(self) -> str:
        """The verdict in a word."""
        if self.agrees is None:
            return "open"
        if self.own:
            return "reached" if self.agrees else "missed"
        return "agree" if self.agrees else "differ"

    @property
    def reason(self) -> str:
        """Why: what was found, and what would agree."""
        return f"{self.ours} ({self.criterion})"


@dataclass(frozen=True)
class DataTable:
    """A table of the report."""

    caption: str
    header: list[str]
    rows: list[list[str]]


@dataclass(frozen=True)
class Figure:
    """One figure, or one group that is one picture.

    Attributes:
        name: What one types for it: "4.3".
        title: Its heading.
        statement: What the paper shows there, in our words.
        jobs: The runs that it needs, all of them or (True) a few that show the shape.
        draw: Draws its data on a matplotlib figure.
        claims: What the data say to the paper's statements.
        table: The numbers behind it.
        size: Of the picture, inches.
    """

    name: str
    title: str
    statement: str
    jobs: Callable[[bool], list[Job]]
    draw: Callable[[Any, Results], None]
    claims: Callable[[Results], list[Claim]]
    table: Callable[[Results], list[DataTable]] = lambda results: []
    size: tuple[float, float] = (10.0, 4.0)


@dataclass(frozen=True)
class Study:
    """A paper that is reproduced.

    Attributes:
        name: What one types for it.
        title: Heading of the report.
        source: The paper.
        setting: How our runs are set up, one paragraph.
        figures: Its figures.
        work: Runs one job, in another process.
        sources: Files and folders that results depend on; a change there runs the jobs again.
        missing: Figures not reproduced yet, and why.
    """

    name: str
    title: str
    source: str
    setting: str
    figures: tuple[Figure, ...]
    work: Callable[[Job], Result]
    sources: tuple[Path, ...] = ()
    missing: dict[str, str] = field(default_factory=dict)

    def choose(self, names: tuple[str, ...]) -> tuple[Figure, ...]:
        """Return the figures of these names, or all.

        Raises:
            UnknownNameError: There is no such figure.
        """
        known = {figure.name: figure for figure in self.figures}
        for name in names:
            if name not in known:
                raise UnknownNameError(f"figure of {self.name}", name, known)
        return tuple(known[name] for name in names) if names else self.figures


def folder_of(package: object) -> Path:
    """Return the folder of an imported package: what a study's runs depend on."""
    return Path(str(getattr(package, "__file__", ""))).parent


def distinct(figures: tuple[Figure, ...], quick: bool) -> Iterator[Job]:
    """Yield the jobs of all figures, each once."""
    seen = set()
    for figure in figures:
        for job in figure.jobs(quick):
            if job not in seen:
                seen.add(job)
                yield job
