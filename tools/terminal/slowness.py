"""Detects a computer or bus that is too slow, from late ticks and plans, and gives advice."""

from dataclasses import dataclass
from typing import Any

TICKS, PLANS = 0.01, 0.05
"""Shares of late ticks and of late plans above which a warning is given."""


@dataclass
class Slowness:
    """Counts of late ticks and plans.

    Attributes:
        rate_hz: Rate of the loop, Hz.
        simulated: Whether time is simulated: ticks are then late because of the bus only.
        ticks: Number of ticks that were run.
        missed: Number of ticks that were late and therefore skipped.
        plans: Number of steps that were planned.
        late: Number of plans that arrived too late to take effect, or never.
        library: Whether the plans already come from learnt step models.
    """

    rate_hz: float
    simulated: bool = False
    ticks: int = 0
    missed: int = 0
    plans: int = 0
    late: int = 0
    library: bool = False

    @property
    def missed_share(self) -> float:
        """Share of the ticks that were late."""
        return _share(self.missed, self.ticks + self.missed)

    @property
    def late_share(self) -> float:
        """Share of the plans that were late."""
        return _share(self.late, self.plans)

    def __bool__(self) -> bool:
        """Return whether a warning is due."""
        return self.missed_share > TICKS or self.late_share > PLANS

    def __str__(self) -> str:
        return f"{self.description}: {self.remedy}"

    @property
    def description(self) -> str:
        """Description of what was late."""
        parts = []
        if self.missed_share > TICKS:
            parts.append(f"{100.0 * self.missed_share:.0f} % of the ticks")
        if self.late_share > PLANS:
            parts.append(f"{self.late} of {self.plans} plans")
        return f"{' and '.join(parts)} came late"

    @property
    def remedy(self) -> str:
        """Cause and advice: late plans are due to the computer, late ticks possibly to the bus."""
        if self.simulated:
            return f"the bus is too slow for {self.rate_hz:g} Hz: try a lower --rate"
        if self.late_share <= PLANS:
            who, remedy = "this computer or its bus", "a lower --rate"
        else:
            who = "this computer"
            remedy = "a lower --rate" if self.library else "`--model library` or a lower --rate"
        return f"{who} is too slow for {self.rate_hz:g} Hz: try {remedy}"

    def count_plans(self, plans: int, late: int, library: bool) -> None:
        """Count the plans of a walk; did they come from learnt step models?"""
        self.plans, self.late, self.library = self.plans + plans, self.late + late, library

    def merge(self, other: "Slowness") -> None:
        """Add the counts of another run."""
        self.ticks, self.missed = self.ticks + other.ticks, self.missed + other.missed
        self.plans, self.late = self.plans + other.plans, self.late + other.late

    def records(self) -> list[dict[str, Any]]:
        """Return the warnings as plain data; their beginning is unknown."""
        late = [
            ("late ticks", self.missed, self.missed_share, TICKS),
            ("late plans", self.late, self.late_share, PLANS),
        ]
        return [
            {
                "kind": kind,
                "joints": [],
                "value": share,
                "limit": limit,
                "count": count,
                "since": None,
            }
            for kind, count, share, limit in late
            if share > limit
        ]


def _share(part: int, whole: int) -> float:
    return part / whole if whole else 0.0
