"""A family of servos: everything in which one make differs from another, as one object.

Whatever works on servos (bus, line, settings, torque switch, units) asks the family and knows no
maker by name.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from windup.hal.errors import UsageError
from windup.hal.families.dialect import ServoProtocol
from windup.hal.families.gain import Gain
from windup.hal.families.usual import Usual, protective_limits
from windup.hal.protocols.protocol2 import Span
from windup.hal.registers import Register, RegisterTable
from windup.hal.servos.servo_model import ServoModel


class RequiredSetting(NamedTuple):
    """What the stack needs a register to be; `mask` says which bits matter, None all."""

    name: str
    value: int
    mask: int | None = None


class Mark(NamedTuple):
    """A register in RAM that shows a restart: arming never leaves in it what a restart does.

    Attributes:
        name: The register.
        restarted: What it holds after a restart.
        armed: What arming sets it to; None where that is the time of a Bus Watchdog, or nothing.
    """

    name: str
    restarted: int
    armed: int | None = None


@dataclass(frozen=True)
class Block:
    """A run of registers that is read in one piece.

    Attributes:
        address: Of its first byte.
        size: Bytes.
        state: Position, velocity, and current or load.
    """

    address: int
    size: int
    state: tuple[Register, Register, Register]

    @cached_property
    def dtype(self) -> np.dtype[Any]:
        """The record of one servo: fields "f0", "f1" and "f2" in the order of `state`."""
        names = [f"f{index}" for index in range(len(self.state))]
        return np.dtype(
            {
                "names": names,
                "formats": [register.dtype for register in self.state],
                "offsets": [register.address - self.address for register in self.state],
                "itemsize": self.size,
            }
        )

    def counts(self, records: npt.NDArray[np.void]) -> tuple[Any, Any, Any]:
        """Return three (n,) arrays, in the order of `state`, from (n,) records of `dtype`."""
        first, second, third = self.state
        return (
            first.values(records["f0"]),
            second.values(records["f1"]),
            third.values(records["f2"]),
        )

    def span(self, id: int) -> Span:
        """Return the block of one servo."""
        return Span(id, self.address, self.size)


class Cycle(NamedTuple):
    """What the cycle of a line reads: always, now and then, and to see that torque is still on."""

    state: Block
    health: Block | None
    check: Block


@dataclass(frozen=True, eq=False)
class Family:
    """Servos that share protocol, register addresses and rules.

    Attributes:
        name: For people.
        protocol: Name of its protocol in robot.toml.
        dialect: How they are spoken to.
        registers: What all models have at the same place, by name; units are the model's.
        table: Model name to all of its registers.
        numbers: Model number to model name.
        bauds: Baud rate to the value of its register.
        state: What a cycle reads.
        current: What a cycle reads where torque is to come from it; None where `state` will do or
            nothing measures current.
        health: `state`, read on to voltage and temperature; None where `check` is read instead.
        check: `health`, and before it the registers of `torque`.
        check_alone: Can one servo be read further on than the others?
        torque: Registers each of which, at 0, says that a servo does not drive.
        torque_bytes: How many bytes hold them, from the first of them on.
        mark: What shows a restart; None where nothing does.
        shutdown: The register whose bits say which errors end torque, or weaken it.
        weakening: Bits of errors that weaken torque instead of ending it.
        latching: Does an error that has ended torque show until the power goes?
        wanted: The settings the stack relies on, in the order in which they are written.
        extended: What is wanted instead where a servo shall count many turns; None where none can.
        usual: How a model protects itself as its maker delivers it; what is set otherwise is its
            owner's, and only shown.
        gain: How stiffness is set on a model.
        alert: Bits of an answer's error byte that say the servo is unwell.
        errors: Bit of an error to its meaning.
        errors_in_answers: Are the bits of the error byte the errors themselves? Else they stand in
            the register `hardware_error`.
        goal_wakes: May a goal switch torque on?
    """

    name: str
    protocol: str
    dialect: ServoProtocol
    registers: Mapping[str, Register]
    table: Callable[[str], RegisterTable]
    numbers: Mapping[int, str]
    bauds: Mapping[int, int]
    state: Block
    health: Block | None
    check: Block
    wanted: Callable[[ServoModel], Sequence[RequiredSetting]]
    gain: Callable[[str], Gain]
    alert: int
    errors: Mapping[int, str]
    shutdown: str
    torque_bytes: int
    torque: tuple[str, ...] = ("torque_enable",)
    mark: Mark | None = None
    weakening: int = 0
    latching: bool = False
    current: Block | None = None
    extended: RequiredSetting | None = None
    usual: Callable[[ServoModel], Sequence[Usual]] = protective_limits
    check_alone: bool = False
    errors_in_answers: bool = True
    goal_wakes: bool = True

    def model_name(self, number: int) -> str:
        """Return the name behind a model number, or "model 999"."""
        return self.numbers.get(number, f"model {number}")

    def explain(self, bits: int) -> tuple[str, ...]:
        """Return what the bits of an error byte or hardware error register mean."""
        return tuple(what for bit, what in self.errors.items() if bits >> bit & 1)

    def baud_code(self, baud: int) -> int:
        """Return the register value of a baud rate.

        Raises:
            UsageError: No servo of the family has this rate.
        """
        if baud not in self.bauds:
            rates = ", ".join(str(rate) for rate in self.bauds)
            raise UsageError(f"baud rate {baud} cannot be; there are {rates}")
        return self.bauds[baud]

    def torque_span(self, id: int) -> Span:
        """Return where the registers of `torque` stand in one servo.

        It has a size that nothing else has that is read: a late answer to another question cannot
        pass for torque that is on, or off.
        """
        address = self.registers["torque_enable"].address
        return Span(id, address, self.torque_bytes)

    def cycle(self, models: Sequence[ServoModel]) -> Cycle:
        """Return what the cycle of a line of `models` reads."""
        if self.current is not None and all(model.torque_constant for model in models):
            long = self.current
            end = long.address + long.size
            check = Block(self.check.address, end - self.check.address, long.state)
            return Cycle(long, long, check)
        return Cycle(self.state, self.health, self.check)
