"""Every fault by name."""

from windup.sim_twin.wire.faults.answer_methods import AnswerFaultMethods
from windup.sim_twin.wire.faults.event_methods import EventMethods


class FaultMethods(AnswerFaultMethods, EventMethods):
    """A method for each kind of fault: of answers on their way, and events.

    Every method adds one fault and returns the object, so that calls can be chained. Keywords of
    all: ``rate`` (share of the answers, 0 to 1) or ``at`` (s), ``ids``, ``bus``; see `Who`.
    """
