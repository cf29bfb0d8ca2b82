"""Hardware alerts of the servos, by joint."""

from collections.abc import Sequence
from contextlib import suppress

import numpy as np
import numpy.typing as npt

from windup.hal.errors import PortError
from windup.hal.families import family_of
from windup.hal.joints import Joints
from windup.hal.servo_bus.bus_connection import BusConnection
from windup.hal.servo_bus.bus_readout import BusReadout
from windup.hal.servos.servo_model import ServoMount

UNKNOWN = "unknown"
ERROR_KINDS = ("no answer", "corrupt", "resynchronised", "implausible")


class ServoAlerts:
    """The servos that report an error, by joint name, while it lasts.

    An alert is not a shutdown: `TorqueCheck` finds out whether a servo still has torque.

    Attributes:
        errors: (n,) error bytes of the last answers.
        now: Maps joint name to the present alerts of its servo.
        kinds: All kinds of alert.
    """

    def __init__(self, joints: Joints, mounts: Sequence[ServoMount]) -> None:
        self._joints = joints
        families = dict.fromkeys(family_of(mount.model.name) for mount in mounts)
        found = [what for family in families for what in family.errors.values()]
        self.kinds = (*dict.fromkeys(found), UNKNOWN)
        self.errors: npt.NDArray[np.uint8] = np.zeros(len(joints), dtype=np.uint8)
        self._mask = np.zeros_like(self.errors)
        self.now: dict[str, tuple[str, ...]] = {}

    def watch(self, readouts: Sequence[BusReadout]) -> None:
        """Set the bits of the error byte that mean an alert, for each bus."""
        for readout in readouts:
            self._mask[readout.rows] = readout.bus.family.alert

    def update(self, links: Sequence[BusConnection]) -> None:
        """Add alerts of servos that newly report an error, and remove those that have ended."""
        if not self.now and not self.errors.any():
            return
        alert = (self.errors & self._mask) != 0
        self.now = {n: said for n, said in self.now.items() if alert[self._joints.index(n)]}
        for readout in [link.readout for link in links if link.lost is None]:
            rows = np.flatnonzero(alert[readout.rows]).tolist()
            if new := [row for row in rows if self._name(readout, row) not in self.now]:
                with suppress(PortError):  # the next request finds that too
                    self._explain(readout, new)

    def _name(self, readout: BusReadout, row: int) -> str:
        return self._joints.names[readout.rows[row]]

    def _explain(self, readout: BusReadout, rows: Sequence[int]) -> None:
        """Record the alerts of the servos at `rows`; one that cannot be read is retried later."""
        family = readout.bus.family
        bits = self.errors[readout.rows[rows]] & family.alert
        said = np.ones(len(rows), dtype=bool)
        if not family.errors_in_answers:
            ids = [readout.ids[row] for row in rows]
            counts, said = readout.bus.sync_read(ids, family.registers["hardware_error"])
            bits = counts.astype(np.uint8)
        for row, code in zip(np.array(rows)[said], bits[said].tolist(), strict=True):
            self.now[self._name(readout, row)] = family.explain(code) or (UNKNOWN,)


def count_errors(links: Sequence[BusConnection], watchdog_trips: int) -> dict[str, int]:
    """Return the number of errors so far by kind; the keys are fixed."""
    counts = dict.fromkeys(ERROR_KINDS, 0)
    for link in links:
        found = link.bus.exchange.errors.get  # a `Counter` looks up missing keys slowly
        for kind in ERROR_KINDS:
            counts[kind] += found(kind, 0)
    counts["unplugged"] = sum(link.losses for link in links)
    counts["watchdog"] = watchdog_trips
    return counts
