"""What a bus needs to know of a protocol."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

from sim_twin.wire.device import Device

if TYPE_CHECKING:
    from sim_twin.wire.bus import Bus


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


class Language(Protocol):
    """A protocol: how bytes become frames, and what devices do with a frame.

    Attributes:
        id_at: Where a frame has its id.
        length_at: Where it has its length, the low byte.
        data_at: Where a status has its data.
        tail: Bytes of its checksum.
    """

    id_at: int
    length_at: int
    data_at: int
    tail: int

    def seal(self, frame: bytes, /) -> bytes:
        """Return `frame` with the checksum that it should have."""
        ...

    def meet(self, devices: Sequence[Device], /) -> None:
        """Take note of who is on the bus; called whenever registers below 64 may have changed."""
        ...

    def feed(self, chunk: bytes) -> list[Heard]:
        """Return the frames that end in `chunk`."""
        ...

    def reset(self) -> None:
        """Forget a frame that has begun."""
        ...

    def execute(self, frame: Heard, bus: "Bus") -> bool:
        """Do what a frame says; False if it was dropped."""
        ...
