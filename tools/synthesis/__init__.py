"""`windup synthesise`: an optimiser finds or improves the gait of a robot."""

from tools.synthesis.command import Synthesise

__all__ = ["Synthesise"]
