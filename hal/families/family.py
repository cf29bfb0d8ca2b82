"""A family of servos: one object with everything in which one maker differs from another.

All code that works on servos (bus, readout, settings, torque, units) uses the family and does not
depend on a maker.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from windup.hal.errors import UsageError
from windup.hal.families.factory_default import FactoryDefault, protective_limits
from windup.hal.families.gain import Gain
from windup.hal.families.servo_protocol import ServoProtocol
from windup.hal.protocols.protocol2 import Span
from windup.hal.registers import Register, RegisterTable
from windup.hal.servos.servo_model import ServoModel


class RequiredSetting(NamedTuple):
    """Value that the stack requires in a register; `mask` selects the bits, None means all."""

    name: str
    value: int
    mask: int | None = None


class RestartMark(NamedTuple):
    """A RAM register that detects a restart: arming sets another value than a restart leaves.

    Attributes:
        name: The register.
        restarted: Its value after a restart.
        armed: Value that arming writes; None if that is the time of a Bus Watchdog, or nothing.
    """

    name: str
    restarted: int
    armed: int | None = None


@dataclass(frozen=True)
class Block:
    """A range of consecutive registers that is read together.

    Attributes:
        address: Address of its first byte.
        size: Size, bytes.
        state: Registers of position, velocity, and current or load.
    """

    address: int
    size: int
    state: tuple[Register, Register, Register]

    @cached_property
    def dtype(self) -> np.dtype[Any]:
        """Record dtype of one servo: fields "f0", "f1" and "f2" in the order of `state`."""
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
        """Return the span of the block in servo `id`."""
        return Span(id, self.address, self.size)


class Cycle(NamedTuple):
    """Blocks that the cycle of a bus reads: each time, periodically, and to check torque."""

    state: Block
    health: Block | None
    check: Block


@dataclass(frozen=True, eq=False)
class Family:
    """Servos that share protocol, register addresses and rules.

    Attributes:
        name: Name for messages.
        protocol_name: Name of its protocol in robot.toml.
        protocol: Its protocol, as implemented by the maker.
        registers: Registers common to all models, by name; units may differ by model.
        table: Returns all registers of a model, by its name.
        numbers: Maps model number to model name, without the winding after a dash.
        models: Data sheets of the models.
        bauds: Maps baud rate to the value of the baud rate register.
        state: Block read in each cycle.
        current: Block read instead if torque is computed from its current; None if `state`
            contains the current, or current is not measured.
        health: `state`, extended to voltage and temperature; None if `check` is read instead.
        check: `health`, extended downwards to the registers of `torque`.
        check_alone: Whether a read may use a longer span for one servo than for the others.
        torque: Registers of which a value of 0 means that a servo has no torque.
        torque_bytes: Number of bytes that contain them, from the first of them on.
        restart_mark: Register that detects a restart, or None.
        shutdown: Register whose bits select the errors that end torque, or reduce it.
        weakening: Bits of errors that reduce torque instead of ending it.
        latching: Whether an error that ended torque is reported until power-off.
        required: Returns the required settings of a model, in the order of writing.
        extended: Setting required instead for extended (multi-turn) position mode, or None.
        factory_defaults: Returns the factory defaults of the protection settings of a model; other
            values are the owner's choice, and only reported.
        gain: Returns how stiffness is set on a model.
        alert: Bits of a status packet's error byte that report a hardware error.
        errors: Maps error bit to its meaning.
        errors_in_answers: Whether the bits of the error byte are the errors themselves; else the
            register `hardware_error` contains them.
        goal_enables_torque: Whether writing a goal may switch torque on.
        emulation: Where the emulation of its servos is, "module:name" of a
            `windup.sim_twin.wire.world.emulation.Emulation`, imported when one is emulated; "" for
            the families of Windup itself, and for one that cannot be emulated.
    """

    name: str
    protocol_name: str
    protocol: ServoProtocol
    registers: Mapping[str, Register]
    table: Callable[[str], RegisterTable]
    numbers: Mapping[int, str]
    models: Sequence[ServoModel]
    bauds: Mapping[int, int]
    state: Block
    health: Block | None
    check: Block
    required: Callable[[ServoModel], Sequence[RequiredSetting]]
    gain: Callable[[str], Gain]
    alert: int
    errors: Mapping[int, str]
    shutdown: str
    torque_bytes: int
    torque: tuple[str, ...] = ("torque_enable",)
    restart_mark: RestartMark | None = None
    weakening: int = 0
    latching: bool = False
    current: Block | None = None
    extended: RequiredSetting | None = None
    factory_defaults: Callable[[ServoModel], Sequence[FactoryDefault]] = protective_limits
    check_alone: bool = False
    errors_in_answers: bool = True
    goal_enables_torque: bool = True
    emulation: str = ""

    def model_name(self, number: int) -> str:
        """Return the name of a model number, or a text such as "model 999" if it is unknown."""
        return self.numbers.get(number, f"model {number}")

    def explain(self, bits: int) -> tuple[str, ...]:
        """Return the meanings of the bits of an error byte or hardware error register."""
        return tuple(what for bit, what in self.errors.items() if bits >> bit & 1)

    def baud_code(self, baud: int) -> int:
        """Return the register value of a baud rate.

        Raises:
            UsageError: The family does not support this rate.
        """
        if baud not in self.bauds:
            rates = ", ".join(str(rate) for rate in self.bauds)
            raise UsageError(f"baud rate {baud} is not supported; use one of {rates}")
        return self.bauds[baud]

    def torque_span(self, id: int) -> Span:
        """Return the span of the registers of `torque` in one servo.

        No other read has the same size, so that a late answer to another request cannot be taken
        for a torque state.
        """
        address = self.registers["torque_enable"].address
        return Span(id, address, self.torque_bytes)

    def cycle(self, models: Sequence[ServoModel]) -> Cycle:
        """Return the blocks that the cycle of a bus with `models` reads."""
        if self.current is not None and all(model.torque_constant for model in models):
            long = self.current
            end = long.address + long.size
            check = Block(self.check.address, end - self.check.address, long.state)
            return Cycle(long, long, check)
        return Cycle(self.state, self.health, self.check)
