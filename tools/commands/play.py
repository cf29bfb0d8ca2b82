"""`windup play`: play a pose graph on a robot."""

from dataclasses import dataclass

from windup.tools.behaviours.play import PLAY, PlayOptions
from windup.tools.commands.behaviour_command import BehaviourCommand
from windup.tools.options.twin_options import TwinOptions


@dataclass(frozen=True, kw_only=True)
class Play(PlayOptions, TwinOptions, BehaviourCommand):
    """Play a pose graph to its end, or for some seconds."""

    behaviour = PLAY
