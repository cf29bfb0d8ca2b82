"""`windup stand`: move a robot into its stance and hold it."""

from dataclasses import dataclass

from windup.tools.behaviours.stand import STAND, StandOptions
from windup.tools.commands.behaviour_command import BehaviourCommand
from windup.tools.options.twin_options import TwinOptions


@dataclass(frozen=True, kw_only=True)
class Stand(StandOptions, TwinOptions, BehaviourCommand):
    """Stand for some seconds; a twin that is pushed over says how hard it fell."""

    behaviour = STAND
