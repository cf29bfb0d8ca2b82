"""A bus of Dynamixels, each of which uses the protocol set in its Protocol Type(13).

AX and old MX servos support protocol 1 only; `world.families` puts them on a bus of their own.
"""

from collections.abc import Sequence
from typing import Final

from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.bus.parsed_item import ParsedItem
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.protocols.dynamixel2 import Dynamixel2
from windup.sim_twin.wire.protocols.frames1 import Frame1, Frame1Error
from windup.sim_twin.wire.protocols.protocol1 import DYNAMIXEL1, Protocol1

OLD: Final = 1


class Dynamixel:
    """Protocol 2, and also protocol 1 while one of the devices uses it.

    The frame layout attributes are those of the protocol that the host used last.
    """

    def __init__(self) -> None:
        self._new, self._old = Dynamixel2(), Protocol1(DYNAMIXEL1)
        self._mixed = False
        self._speak(self._new)

    def set_devices(self, devices: Sequence[Device]) -> None:
        """Check which protocols the devices use now."""
        self._mixed = any(device.protocol == OLD for device in devices)

    def feed(self, chunk: bytes) -> list[ParsedItem]:
        """Return the frames of both protocols that `chunk` completes.

        Frames of protocol 2 are noise to the parser of protocol 1, so its noise is not reported.
        """
        found = self._new.feed(chunk)
        if not self._mixed:
            return found
        old = [item for item in self._old.feed(chunk) if not item.noise]
        return sorted([*found, *old], key=lambda item: item.end)

    def reset(self) -> None:
        """Discard incomplete frames."""
        self._new.reset()
        self._old.reset()

    def execute(self, frame: ParsedItem, bus: Bus) -> bool:
        """Let the devices of its protocol execute a frame; return False if it was dropped."""
        old = isinstance(frame, Frame1 | Frame1Error)
        half = self._old if old else self._new
        bus.spoken = OLD if old else 2
        if not frame.noise:
            self._speak(half)
        return half.execute(frame, bus)

    def _speak(self, half: Dynamixel2 | Protocol1) -> None:
        """Take over the frame layout of one protocol."""
        self.id_at, self.length_at = half.id_at, half.length_at
        self.data_at, self.tail, self.with_checksum = half.data_at, half.tail, half.with_checksum
