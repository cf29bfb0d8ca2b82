"""Conversion between servo counts and SI units of joints, as arrays in joint order.

By the mount of each servo: ``counts = zero + sign ratio q counts_per_rev / (2 pi)``.
"""

from collections.abc import Sequence
from math import pi

import numpy as np
import numpy.typing as npt

from windup.hal.families import family_of
from windup.hal.families.gain import Gain
from windup.hal.joints import Array, Mask
from windup.hal.servos.servo_model import ServoMount

Rows = npt.NDArray[np.intp]


class Units:
    """Conversion for n servos, one at each joint.

    Attributes:
        counts_per_rad: (n,) counts per rad of the joint, signed.
        zero: (n,) counts at joint angle 0.
        scale: (3, n) SI value of one count of position (rad), velocity (rad/s) and torque (N m).
            The torque of a servo that measures load instead of current is NaN.
        offset: (3, n) counts at which each of them is 0.
        first: (n,) smallest goal position of the servo, counts.
        last: (n,) largest goal position of the servo, counts.
        speed: (n,) no-load speed of the servo, counts/s.
        speed_unit: (n,) one unit of its velocity register, counts/s.
        stiffness: (n,) stiffness at the joint for one unit of the P register, N m/rad.
        damping: (n,) damping of the motor itself at the joint, N m s/rad.
        gains: Gain registers, each with the indices of its servos.
    """

    def __init__(self, mounts: Sequence[ServoMount], supply: float) -> None:
        sign = np.array([mount.sign for mount in mounts], dtype=np.float64)
        ratio = np.array([mount.ratio for mount in mounts])
        per_turn = np.array([mount.model.counts_per_rev for mount in mounts])
        self.counts_per_rad: Array = np.array([mount.counts_per_rad for mount in mounts])
        self.zero: Array = np.array([mount.zero for mount in mounts], dtype=np.float64)
        self.first: Array = np.array([mount.first_count for mount in mounts], dtype=np.float64)
        self.last: Array = np.array([mount.last_count for mount in mounts], dtype=np.float64)
        motors = [mount.model.motor(supply) for mount in mounts]
        self.speed: Array = np.array([m.no_load_speed for m in motors]) * per_turn / (2.0 * pi)
        velocity = np.array([_velocity_per_count(mount) for mount in mounts])
        self.speed_unit: Array = velocity * per_turn / (2.0 * pi)
        torque = np.array([_torque_per_count(mount, mounts) for mount in mounts])
        self.scale: Array = np.stack(
            [1.0 / self.counts_per_rad, sign * velocity / ratio, sign * ratio * torque]
        )
        self.offset: Array = np.zeros_like(self.scale)
        self.offset[0] = self.zero
        # Torque is multiplied and angle divided by the ratio, so gains scale with its square.
        each = np.array([mount.model.stiffness(1.0, supply) for mount in mounts])
        own = np.array([mount.model.damping(supply) for mount in mounts])
        self.stiffness: Array = ratio**2 * each
        self.damping: Array = ratio**2 * own
        self.gains: list[tuple[Gain, Rows]] = gain_groups(mounts)

    def to_si(self, counts: Array) -> Array:
        """Return position rad, velocity rad/s and torque N m (3, n) from counts (3, n)."""
        return np.asarray((counts - self.offset) * self.scale)

    def counts(self, position: Array) -> Array:
        """Return the counts (n,), not rounded, for joint angles (n,) rad."""
        return np.asarray(position * self.counts_per_rad + self.zero)

    def angle(self, counts: Array) -> Array:
        """Return the joint angles (n,) rad for counts (n,)."""
        return np.asarray((counts - self.zero) * self.scale[0])

    def p_registers(self, stiffness: Array) -> tuple[Array, Mask]:
        """Return P registers (n,) nearest to `stiffness` (n,) N m/rad, and which are clamped.

        A P register is clamped where the wanted stiffness exceeds its range.
        """
        registers = stiffness / self.stiffness
        beyond: Mask = np.zeros(len(registers), dtype=bool)
        for gain, rows in self.gains:
            nearest = gain.nearest(registers[rows])
            inside = gain.within(nearest)
            beyond[rows] = inside != nearest
            registers[rows] = inside
        return registers, beyond


def gain_groups(mounts: Sequence[ServoMount]) -> list[tuple[Gain, Rows]]:
    """Return each gain register, with the indices of its mounts."""
    groups: dict[Gain, list[int]] = {}
    for row, mount in enumerate(mounts):
        groups.setdefault(family_of(mount.model.name).gain(mount.model.name), []).append(row)
    return [(gain, np.array(rows, dtype=np.intp)) for gain, rows in groups.items()]


def _velocity_per_count(mount: ServoMount) -> float:
    """Return one count of the servo's velocity register, rad/s at the servo."""
    table = family_of(mount.model.name).table(mount.model.name)
    return table["present_velocity"].unit


def _torque_per_count(mount: ServoMount, mounts: Sequence[ServoMount]) -> float:
    """Return the torque of one count of the current read, N m at the servo; NaN if it is load."""
    family, constant = family_of(mount.model.name), mount.model.torque_constant
    table = family.table(mount.model.name)
    if constant is None or "present_current" not in table:
        return float("nan")
    neighbours = [other.model for other in mounts if other.bus == mount.bus]
    read, current = family.cycle(neighbours)[0].state[2], table["present_current"]
    return current.unit * constant if read.address == current.address else float("nan")
