"""What a protocol has understood of the bytes on a bus."""

from typing import Protocol


class Heard(Protocol):
    """A frame, or something that was dropped, with the bytes of the chunk that it ends at."""

    @property
    def end(self) -> int:
        """Bytes of the chunk up to its end."""
        ...

    @property
    def noise(self) -> bool:
        """Whether it is nothing that anybody could answer to."""
        ...
