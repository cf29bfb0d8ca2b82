"""When a run is ended: what it is busy with, and since when."""

from dataclasses import dataclass
from typing import Literal

Activity = Literal["standing", "walking", "closing crouch"]
ACTIVITIES: tuple[Activity, ...] = ("standing", "walking", "closing crouch")


@dataclass(frozen=True)
class Moment:
    """When a run is ended.

    Attributes:
        activity: While it is busy with this.
        after: So long after that began, s.
    """

    activity: Activity
    after: float
