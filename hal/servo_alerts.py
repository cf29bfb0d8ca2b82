"""Which joint's servo is unwell, and what of."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hal.bus import Bus
from hal.errors import HardwareError
from hal.families import family_of
from hal.joints import Joints
from hal.servo_line import ServoLine
from hal.servo_link import ServoLink
from hal.servo_model import ServoMount

UNKNOWN = "unknown"
ERROR_KINDS = ("no answer", "corrupt", "resynchronised", "implausible")


class ServoAlerts:
    """The servos that signal an error, by joint name, while it lasts.

    Attributes:
        errors: (n,) error bytes of the last answers.
        now: Joint name to what is wrong.
        kinds: All that can be wrong.
    """

    def __init__(self, joints: Joints, mounts: Sequence[ServoMount]) -> None:
        self._joints = joints
        families = dict.fromkeys(family_of(mount.model.name) for mount in mounts)
        found = [what for family in families for what in family.errors.values()]
        self.kinds = (*dict.fromkeys(found), UNKNOWN)
        self.errors: npt.NDArray[np.uint8] = np.zeros(len(joints), dtype=np.uint8)
        self._mask = np.zeros_like(self.errors)
        self.now: dict[str, tuple[str, ...]] = {}

    def watch(self, lines: Sequence[ServoLine]) -> None:
        """Take note of which bits mean an alert on each line."""
        for line in lines:
            self._mask[line.rows] = line.bus.family.alert

    def update(self, links: Sequence[ServoLink]) -> None:
        """Explain the servos that newly signal an error, and forget the others."""
        if not self.now and not self.errors.any():
            return
        alert = (self.errors & self._mask) != 0
        known = {name for name in self.now if alert[self._joints.index(name)]}
        self.now = {name: self.now[name] for name in known}
        lines = [link.line for link in links if link.lost is None]
        for line in lines:
            for id, row in zip(line.ids, line.rows.tolist(), strict=True):
                name = self._joints.names[row]
                if alert[row] and name not in known:
                    self.now[name] = _explain(line.bus, id, int(self.errors[row] & self._mask[row]))


def _explain(bus: Bus, id: int, error: int) -> tuple[str, ...]:
    family = bus.family
    bits = error
    if not family.errors_in_answers:
        try:
            bits = bus.read(id, family.registers["hardware_error"])
        except HardwareError:
            bits = 0
    return family.explain(bits) or (UNKNOWN,)


def count_errors(links: Sequence[ServoLink], watchdog_trips: int) -> dict[str, int]:
    """Return kind of error to how often it has happened; the kinds are always the same."""
    counts = dict.fromkeys(ERROR_KINDS, 0)
    for link in links:
        for kind in ERROR_KINDS:
            counts[kind] += link.bus.exchange.errors[kind]
    counts["unplugged"] = sum(link.losses for link in links)
    counts["watchdog"] = watchdog_trips
    return counts
