"""The header of a telemetry ring: all that stays the same from tick to tick, as JSON in its file.

The header describes the record of a tick completely: a program that knows the file's layout can
read a ring without any other table of ours.
"""

import msgspec
import numpy as np

from windup.hal.command import FIELDS as ROWS
from windup.hal.guard import HealthKind
from windup.hal.guard.finding import FINDING_TEXTS
from windup.hal.guard.imu_watch import IMU_KINDS
from windup.hal.publishing.controller_block import MOST_VALUES
from windup.hal.publishing.run_state import RunState
from windup.hal.telemetry.fields import Field, fields_of

STATES = tuple(state.words for state in RunState)
WARNING_KINDS = (*(FINDING_TEXTS[kind].name for kind in HealthKind), *IMU_KINDS)


class Header(msgspec.Struct, frozen=True, kw_only=True):
    """The constant data of a ring.

    Attributes:
        robot: Name of the robot.
        port: URL of its port, or None for a twin.
        rate_hz: Rate of the loop, Hz.
        joints: Names of the n joints.
        contacts: Names of the k contact sensors.
        clamps: Names of the clamps that the guard counts.
        driver_clamps: Names of the clamps that the servo driver counts.
        errors: Kinds of bus errors that are counted.
        alerts: Meanings of the bits of `alert`, lowest first.
        pid: Process id of the writer.
        started: Time when the writer began, s since 1970.
        estimated: Whether the base state is estimated from the IMU.
        versions: Maps a program to its version, such as "windup".
        command_rows: Names of the rows of `asked` and `applied`.
        states: Names of the codes of `state`.
        warning_kinds: Meanings of the bits of `warnings` and `joint_warnings`, lowest first.
        fields: The fields of the record of a tick.
        record_size: Size of a record, bytes.
    """

    robot: str
    port: str | None
    rate_hz: float
    joints: tuple[str, ...]
    contacts: tuple[str, ...]
    clamps: tuple[str, ...] = ROWS
    driver_clamps: tuple[str, ...] = ()
    errors: tuple[str, ...] = ()
    alerts: tuple[str, ...] = ()
    pid: int = 0
    started: float = 0.0
    estimated: bool = False
    versions: dict[str, str] = {}
    command_rows: tuple[str, ...] = ROWS
    states: tuple[str, ...] = STATES
    warning_kinds: tuple[str, ...] = WARNING_KINDS
    fields: tuple[Field, ...] = ()
    record_size: int = 0

    @property
    def clamp_bits(self) -> tuple[str, ...]:
        """Meanings of the bits of `clamped_by`, lowest first."""
        guard = (f"guard {name}" for name in self.clamps)
        return (*guard, *(f"driver {name}" for name in self.driver_clamps))

    def with_fields(self) -> "Header":
        """Return this header with the fields of a record for its joints, contacts and clamps."""
        fields, size = fields_of(
            {
                "n": len(self.joints),
                "k": len(self.contacts),
                "c": len(self.clamps),
                "d": len(self.driver_clamps),
                "e": len(self.errors),
                "v": MOST_VALUES,
            }
        )
        return msgspec.structs.replace(self, fields=fields, record_size=size)

    def dtype(self) -> np.dtype[np.void]:
        """Return the NumPy type of a record.

        Raises:
            ValueError: The fields do not describe one.
        """
        try:
            return np.dtype(
                {
                    "names": [field.name for field in self.fields],
                    "formats": [(field.type, field.shape) for field in self.fields],
                    "offsets": [field.offset for field in self.fields],
                    "itemsize": self.record_size,
                }
            )
        except TypeError as error:
            raise ValueError(f"its fields are described wrongly: {error}") from None

    def offset(self, name: str) -> int:
        """Return the offset of the field `name` within a record, bytes."""
        return next(field.offset for field in self.fields if field.name == name)


class RunNames(msgspec.Struct, frozen=True):
    """The names of one run's controller, for the codes and values of its ticks.

    Attributes:
        run: Number of the run in the ring.
        controller: Name of the class of the innermost controller.
        phases: Names of the codes of `phase`.
        reasons: Names of the codes of `reason`.
        values: Names of the first numbers of `values`; the others are NaN.
        units: Their units; "1" for ratios.
    """

    run: int
    controller: str = ""
    phases: tuple[str, ...] = ()
    reasons: tuple[str, ...] = ()
    values: tuple[str, ...] = ()
    units: tuple[str, ...] = ()


class Mark(msgspec.Struct, frozen=True):
    """An event in a ring.

    Attributes:
        number: Number of the mark in the ring, from 1.
        sequence: Number of the last tick before it; 0 before any.
        monotonic: CLOCK_MONOTONIC of the computer, s.
        text: What happened.
    """

    number: int
    sequence: int
    monotonic: float
    text: str


def bits_of(bits: int, names: tuple[str, ...]) -> list[str]:
    """Return the names of the bits that are set in `bits`, lowest first.

    >>> bits_of(0b101, ("heat", "load", "voltage"))
    ['heat', 'voltage']
    """
    return [name for bit, name in enumerate(names) if int(bits) >> bit & 1]
