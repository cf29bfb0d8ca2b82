"""The fields of the record of a tick in a telemetry ring, in order; the documentation lists them.

Shapes are numbers or names of sizes: n joints, k contact sensors, c clamps of the guard, d clamps
of the servo driver, e kinds of bus errors, v values of a controller, 5 rows of a `JointCommand`.
Types are those of NumPy, little-endian. What is not measured or not known is NaN.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from math import prod
from typing import Final

import msgspec

TABLE: Final = """
sequence              u8  -    -      number of the tick in the ring, from 1; 0 while it is written
checksum              u4  -    -      CRC-32 of what follows, initialised with the sequence number
run                   u4  -    -      number of the run in the ring, from 1
time                  f8  -    s      timestamp of the observation on the backend's clock
monotonic             f8  -    s      CLOCK_MONOTONIC of the computer when the record was written
wall                  f8  -    s      time since 1970 when the record was written
tick_time             f8  -    s      duration of read, estimate, step and write, without rollouts
lateness              f8  -    s      time from the scheduled start of the tick until it began
plan_lateness         f8  -    s      time from when the last plan was due until it was applied
phase_time            f8  -    s      time in the present phase
imu_age               f8  -    s      time since the IMU sample was taken; NaN without an IMU
base_confidence       f8  -    1      from 0, no base state, to 1, ground truth
supply                f8  -    V      lowest voltage of all joints, ten times a second
hottest               f8  -    degC   highest temperature of all joints, ten times a second
tick                  u8  -    -      number of ticks of the run so far
missed                u8  -    -      number of ticks of the run that were skipped, being too late
plans                 u8  -    -      number of plans of the run
late_plans            u8  -    -      number of plans of the run that came too late
state                 u4  -    -      state of the run: a code of `states`
phase                 i4  -    -      phase of the controller: a code of the run's `phases`, or -1
reason                i4  -    -      why it does that: a code of the run's `reasons`, or -1
hottest_joint         i4  -    -      index of the hottest joint, or -1
warnings              u4  -    -      present health warnings: bits of `warning_kinds`
marks                 u4  -    -      number of marks in the ring so far
position              f8  n    rad    measured joint positions
velocity              f8  n    rad/s  measured joint velocities
torque                f8  n    N*m    joint torques from motor current
voltage               f8  n    V      supply voltages of the servos
temperature           f8  n    degC   motor temperatures
age                   f8  n    s      time since each servo last answered
health_age            f8  n    s      time since voltage and temperature were measured
contacts              f8  k    N      normal forces of the contact sensors
imu_orientation       f8  4    1      quaternion wxyz, body to world
imu_angular_velocity  f8  3    rad/s  in the body frame
imu_acceleration      f8  3    m/s2   specific force in the body frame; at rest +9.81 upwards
base_position         f8  3    m      in the world frame
base_orientation      f8  4    1      quaternion wxyz, body to world
base_linear_velocity  f8  3    m/s    in the world frame
base_angular_velocity f8  3    rad/s  in the body frame
asked                 f8  5,n  -      command of the controller, rows as `command_rows`
applied               f8  5,n  -      command that the joints really got, rows as `command_rows`
values                f8  v    -      values of the controller; the run has their names and units
clamps                u8  c    -      commands that each clamp of the guard has changed so far
driver_clamps         u8  d    -      commands that each clamp of the driver has changed so far
errors                u8  e    -      bus errors of each kind so far
clamped               u8  n    -      commands in which the guard has clamped each joint so far
clamped_by            u4  n    -      what clamped each joint in this tick: bits of `clamp_bits`
alert                 u4  n    -      what each servo signals: bits of `alerts`
joint_warnings        u4  n    -      health warnings of each joint: bits of `warning_kinds`
"""


class Field(msgspec.Struct, frozen=True):
    """One field of a record, as the header of its ring describes it.

    Attributes:
        name: Name of the field.
        type: NumPy type of its numbers.
        shape: Its shape; empty for a single number.
        offset: First byte within the record.
        unit: SI unit; "1" for ratios; "" for codes and counts, and where the rows differ.
        meaning: What it is.
    """

    name: str
    type: str
    shape: tuple[int, ...]
    offset: int
    unit: str
    meaning: str


@dataclass(frozen=True)
class FieldKind:
    """One line of `TABLE`: a field before the sizes are known; see `Field`."""

    name: str
    type: str
    shape: tuple[str, ...]
    unit: str
    meaning: str

    def sized(self, sizes: Mapping[str, int], offset: int) -> Field:
        """Return the field for the named sizes at an offset, bytes."""
        shape = tuple(int(size) if size.isdigit() else sizes[size] for size in self.shape)
        return Field(self.name, self.type, shape, offset, self.unit, self.meaning)


def _kind(line: str) -> FieldKind:
    name, type, shape, unit, meaning = re.split(r" +", line, maxsplit=4)
    sizes = () if shape == "-" else tuple(shape.split(","))
    return FieldKind(name, f"<{type}", sizes, "" if unit == "-" else unit, meaning)


KINDS: Final = tuple(_kind(line) for line in TABLE.strip().splitlines())


def fields_of(sizes: Mapping[str, int]) -> tuple[tuple[Field, ...], int]:
    """Return all fields for the named sizes, and the size of a record, bytes.

    Each field begins at a multiple of the size of its numbers.
    """
    found, offset = [], 0
    for kind in KINDS:
        width = int(kind.type[-1])
        found.append(kind.sized(sizes, -(-offset // width) * width))
        offset = found[-1].offset + width * prod(found[-1].shape)
    return tuple(found), -(-offset // 8) * 8
