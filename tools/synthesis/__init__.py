"""`windup synthesise`: an optimiser finds or improves the gait of a robot."""

from windup.tools.synthesis.command import Synthesise

__all__ = ["Synthesise"]
