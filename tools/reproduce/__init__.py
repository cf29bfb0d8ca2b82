"""`windup reproduce`: the figures of a paper again, ours beside its statements."""

from tools.reproduce.command import Reproduce

__all__ = ["Reproduce"]
