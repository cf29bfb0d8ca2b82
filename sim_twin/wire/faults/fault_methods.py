"""One method for each kind of fault."""

from windup.sim_twin.wire.faults.answer_methods import AnswerFaultMethods
from windup.sim_twin.wire.faults.event_methods import EventMethods


class FaultMethods(AnswerFaultMethods, EventMethods):
    """One method for each kind of fault: faults of answers in transit, and events.

    Each method adds one fault and returns the object, so that calls can be chained. All take the
    keywords ``rate`` (share of the answers, 0 to 1) or ``at`` (s), ``ids`` and ``bus``; see
    `TargetKeywords`.
    """
