"""Which joint's servo is unwell, and what of."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hal.bus import Bus
from hal.errors import HardwareError
from hal.joints import Joints
from hal.servo_line import ServoLine
from hal.servo_link import ServoLink


class ServoAlerts:
    """The servos that signal an error, by joint name, while it lasts.

    Attributes:
        errors: (n,) error bytes of the last answers.
        now: Joint name to what is wrong.
    """

    def __init__(self, joints: Joints) -> None:
        self._joints = joints
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
    return family.explain(bits) or ("unknown",)
