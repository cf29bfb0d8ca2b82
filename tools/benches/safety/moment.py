"""The moment at which a run is ended: its activity, and the time since that began."""

from dataclasses import dataclass
from typing import Literal

Activity = Literal["standing", "walking", "closing crouch"]
ACTIVITIES: tuple[Activity, ...] = ("standing", "walking", "closing crouch")


@dataclass(frozen=True)
class Moment:
    """The moment at which a run is ended.

    Attributes:
        activity: Activity of the run at that moment.
        after: Time since the beginning of the activity, s.
    """

    activity: Activity
    after: float
