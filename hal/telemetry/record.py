"""The record of one tick, as the writer fills it in: one buffer, used again every tick."""

import struct

import numpy as np

from windup.hal.command import JointCommand
from windup.hal.joints import Array
from windup.hal.observation import Observation
from windup.hal.telemetry.fields import KINDS
from windup.hal.telemetry.header import Header
from windup.hal.telemetry.layout import CHECK

CODES = {"<f8": "d", "<u8": "Q", "<u4": "I", "<i4": "i"}
FIRST, LAST = "run", "marks"
"""The first and last of the single numbers, which are packed together."""


class Record:
    """The bytes of a record, with views of its parts.

    Args:
        header: Header of the ring.

    Attributes:
        data: All bytes.
        payload: The bytes that the checksum covers.
        values: (v,) the values of the controller.
        clamped: (n,) commands in which the guard has clamped each joint.
        clamped_by: (n,) bits of what clamped each joint.
        alert: (n,) bits of what each servo signals.
        joint_warnings: (n,) bits of the health warnings of each joint.
    """

    def __init__(self, header: Header) -> None:
        record = np.zeros(1, dtype=header.dtype())
        self.data = record.view(np.uint8).data
        self.payload = self.data[CHECK.size :]
        names = [kind.name for kind in KINDS]
        scalars = KINDS[names.index(FIRST) : names.index(LAST) + 1]
        self._scalars = struct.Struct("<" + "".join(CODES[kind.type] for kind in scalars))
        begin, end = header.offset("position"), header.offset("asked")
        self._measured = record.view(np.uint8)[begin:end].view(np.float64)
        self._asked, self._applied = record["asked"][0], record["applied"][0]
        self.values: Array = record["values"][0]
        self.values.fill(np.nan)
        self.clamped, self.clamped_by = record["clamped"][0], record["clamped_by"][0]
        self.alert, self.joint_warnings = record["alert"][0], record["joint_warnings"][0]
        counts = len(header.clamps) + len(header.driver_clamps) + len(header.errors)
        self._counters, self._counters_at = struct.Struct(f"<{counts}Q"), header.offset("clamps")
        self._no_age = np.full(len(header.joints), 0.0)
        self._none3, self._none4 = np.full(3, np.nan), np.full(4, np.nan)

    def put_scalars(self, *numbers: float) -> None:
        """Put in all single numbers, in the order of the fields."""
        self._scalars.pack_into(self.data, CHECK.size, *numbers)

    def put_counters(self, counters: list[int]) -> None:
        """Put in the counters of the guard's clamps, the driver's clamps and the bus errors."""
        self._counters.pack_into(self.data, self._counters_at, *counters)

    def put_commands(self, asked: JointCommand, applied: JointCommand) -> None:
        """Put in what the controller asked for, and what the joints really got."""
        self._asked[...] = asked.block
        self._applied[...] = applied.block

    def put_observation(self, observation: Observation) -> None:
        """Put in the arrays of an observation."""
        joints, imu, base = observation.joints, observation.imu, observation.base
        no3, no4 = self._none3, self._none4
        np.concatenate(
            (
                joints.position,
                joints.velocity,
                joints.torque,
                joints.voltage,
                joints.temperature,
                joints.age,
                self._no_age if joints.health_age is None else joints.health_age,
                observation.contacts,
                no4 if imu is None or imu.orientation is None else imu.orientation,
                imu.angular_velocity if imu else no3,
                imu.acceleration if imu else no3,
                base.position if base else no3,
                base.orientation if base else no4,
                base.linear_velocity if base else no3,
                base.angular_velocity if base else no3,
            ),
            out=self._measured,
        )
