"""The encoder of a servo: conversion between horn angle and register counts."""

from typing import Final

from windup.sim_twin.wire.servos.register_file import RegisterFile
from windup.sim_twin.wire.servos.x_series import CENTRE, COUNTS, COUNTS_PER_RAD, POSITION

REVERSE: Final = 0x01  # bit of the drive mode
HOMING_MOST: Final = 1024  # counts; position mode ignores larger homing offsets (e-Manual)


class Encoder:
    """``counts = 2048 + sign (angle 4096 / (2 pi) + whole turns) + homing offset``.

    The e-Manual, Present Position(132): after the turns are forgotten, the position lies within one
    turn before the homing offset is added, so with an offset it may be negative.

    Attributes:
        sign: -1 in reverse mode. It inverts position, velocity, current and PWM, but not the homing
            offset.
        homing: Homing offset that is effective in the present mode, counts.
        fold: Whole turns added, counts, in the direction of the horn.
    """

    def __init__(self) -> None:
        self.sign, self.homing, self.fold = 1, 0, 0

    def load(self, registers: RegisterFile) -> None:
        """Update from the registers that affect the conversion."""
        self.sign = -1 if registers.get("drive_mode") & REVERSE else 1
        offset = registers.get("homing_offset")
        one_turn = registers.get("operating_mode") == POSITION
        self.homing = 0 if one_turn and abs(offset) > HOMING_MOST else offset

    def counts(self, angle: float) -> int:
        """Return the counts at `angle` rad."""
        return round(CENTRE + self.sign * (angle * COUNTS_PER_RAD + self.fold)) + self.homing

    def angle(self, counts: float) -> float:
        """Return the angle of `counts`, rad."""
        return (self.sign * (counts - CENTRE - self.homing) - self.fold) / COUNTS_PER_RAD

    def forget_turns(self, angle: float) -> None:
        """Set `fold` so that the counts at `angle` rad, without homing offset, are in one turn."""
        self.fold = 0
        turns = (self.counts(angle) - self.homing) // COUNTS
        self.fold = -self.sign * COUNTS * turns
