"""Between the counts of servos and the SI of joints, as arrays in joint order.

The mount says how a servo sits: ``counts = zero + sign ratio q counts_per_rev / (2 pi)``.
"""

from collections.abc import Sequence
from math import pi

import numpy as np

from hal.joints import Array
from hal.servo_model import ServoMount
from hal.servos.x_series_registers import x_series_registers


class Units:
    """Conversion for n servos, one at each joint.

    Attributes:
        counts_per_rad: (n,) counts for one rad of the joint, signed.
        zero: (n,) counts at joint angle 0.
        scale: (3, n) SI of one count of position (rad), velocity (rad/s) and torque (N m). The
            torque of a servo that measures no current (register 126 is load there) is nan.
        offset: (3, n) counts at which each of them is 0.
        stiffness: (n,) N m/rad at the joint for one unit of the P register.
        damping: (n,) N m s/rad at the joint that the motor has by itself.
    """

    def __init__(self, mounts: Sequence[ServoMount], supply: float) -> None:
        sign = np.array([mount.sign for mount in mounts], dtype=np.float64)
        ratio = np.array([mount.ratio for mount in mounts])
        per_turn = np.array([mount.model.counts_per_rev for mount in mounts])
        self.counts_per_rad: Array = sign * ratio * per_turn / (2.0 * pi)
        self.zero: Array = np.array([mount.zero for mount in mounts], dtype=np.float64)
        tables = [x_series_registers(mount.model.name) for mount in mounts]
        speed = np.array([table["present_velocity"].unit for table in tables])
        torque = np.array([_torque_per_count(mount) for mount in mounts])
        self.scale: Array = np.stack(
            [1.0 / self.counts_per_rad, sign * speed / ratio, sign * ratio * torque]
        )
        self.offset: Array = np.zeros_like(self.scale)
        self.offset[0] = self.zero
        # Torque grows with the ratio and the angle shrinks with it: gains carry its square.
        each = np.array([mount.model.stiffness(1.0, supply) for mount in mounts])
        own = np.array([mount.model.damping(supply) for mount in mounts])
        self.stiffness: Array = ratio**2 * each
        self.damping: Array = ratio**2 * own

    def si(self, counts: Array) -> Array:
        """Return (3, n) position rad, velocity rad/s and torque N m from counts (3, n)."""
        return np.asarray((counts - self.offset) * self.scale)

    def counts(self, position: Array) -> Array:
        """Return the counts (n,), not rounded, of joint angles (n,) rad."""
        return np.asarray(position * self.counts_per_rad + self.zero)

    def angle(self, counts: Array) -> Array:
        """Return the joint angles (n,) rad at counts (n,)."""
        return np.asarray((counts - self.zero) * self.scale[0])


def _torque_per_count(mount: ServoMount) -> float:
    """Return N m at the servo for one count of register 126, nan where that is not current."""
    table = x_series_registers(mount.model.name)
    constant = mount.model.torque_constant
    if "present_current" not in table or constant is None:
        return float("nan")
    return table["present_current"].unit * constant
