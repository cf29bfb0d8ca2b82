"""`windup reproduce`: the figures of a paper again, ours beside its statements."""

from windup.tools.reproduce.command import Reproduce

__all__ = ["Reproduce"]
