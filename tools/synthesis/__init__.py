"""`windup synthesise`: optimises or finds the gait of a robot."""

from windup.tools.synthesis.command import Synthesise

__all__ = ["Synthesise"]
