"""`windup stride`: walk and halt in any direction as the inverted pendulum plans it."""

from dataclasses import dataclass

from windup.tools.behaviours.stride import STRIDE, StrideOptions
from windup.tools.commands.behaviour_command import BehaviourCommand
from windup.tools.options.twin_options import TwinOptions


@dataclass(frozen=True, kw_only=True)
class Stride(StrideOptions, TwinOptions, BehaviourCommand):
    """Walk in any direction and halt, with steps that an inverted pendulum plans.

    `windup walk` is another walk: a limit cycle of a pose graph, faster, and not to be halted
    between two steps.
    """

    behaviour = STRIDE
