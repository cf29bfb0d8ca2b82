"""`windup rise`: get a robot up from its front or its back."""

from dataclasses import dataclass

from windup.tools.behaviours.rise import RISE, RiseOptions
from windup.tools.commands.behaviour_command import BehaviourCommand
from windup.tools.options.twin_options import TwinOptions


@dataclass(frozen=True, kw_only=True)
class Rise(RiseOptions, TwinOptions, BehaviourCommand):
    """Get up from where it lies: look on which side, play get_up_front or get_up_back, stand."""

    behaviour = RISE
