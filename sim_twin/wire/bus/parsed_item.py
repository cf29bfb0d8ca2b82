"""Interface of what a protocol parser returns: frames, and bytes that it dropped."""

from typing import Protocol


class ParsedItem(Protocol):
    """A frame or a dropped item, and where in the parsed chunk it ends."""

    @property
    def end(self) -> int:
        """Number of bytes of the chunk up to its end."""
        ...

    @property
    def noise(self) -> bool:
        """Whether it contains no frame that a device could respond to."""
        ...
