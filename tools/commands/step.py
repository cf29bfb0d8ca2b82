"""`windup step`: one directed step."""

from dataclasses import dataclass

from windup.tools.behaviours.step import STEP, StepOptions
from windup.tools.commands.behaviour_command import BehaviourCommand
from windup.tools.options.twin_options import TwinOptions


@dataclass(frozen=True, kw_only=True)
class Step(StepOptions, TwinOptions, BehaviourCommand):
    """Put one foot where it is told: the weight goes over the other one first."""

    behaviour = STEP
