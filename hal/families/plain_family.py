"""A family of position servos whose reads follow from where its registers are.

For other distributions. A family that needs more (several kinds of gain, settings by model, a mark
that shows a restart) is made as `Family` by itself.
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import count

from windup.hal.families.family import Block, Family, RequiredSetting
from windup.hal.families.gain import Gain
from windup.hal.families.servo_protocol import ServoProtocol
from windup.hal.registers import Register, RegisterTable
from windup.hal.servos.servo_model import ServoModel

EFFORTS = ("present_current", "present_load")
"""Registers of the torque, the better one first."""
SINGLE = (1, 2, 4)
"""Sizes of reads of one register, bytes."""


def plain_family(
    name: str,
    protocol_name: str,
    protocol: ServoProtocol,
    registers: Sequence[Register],
    models: Sequence[ServoModel],
    bauds: Mapping[int, int],
    errors: Mapping[int, str],
    required: Sequence[RequiredSetting] = (),
    largest_p: int = 254,
    emulation: str = "",
) -> Family:
    """Return a family whose torque, state, voltage and temperature are read in one span.

    Args:
        name: Name for messages.
        protocol_name: Name of its protocol in robot.toml.
        protocol: Its protocol, as implemented by the maker.
        registers: Its registers, the same for all models, with the names of `hal/servos`.
        models: Data sheets of the models.
        bauds: Maps baud rate to the value of the baud rate register.
        errors: Maps error bit to its meaning, such as "input voltage", "overheating", "overload".
        required: The required settings, in the order of writing.
        largest_p: Largest value of the register `position_p_gain`.
        emulation: Where the emulation of its servos is; see `Family`.

    Raises:
        ValueError: A register is missing, or is not where one span can have it.
    """
    table = RegisterTable(name, registers)
    blocks = _blocks(name, table)
    gain = Gain(_register(name, table, "position_p_gain"), largest_p)
    return Family(
        name=name,
        protocol_name=protocol_name,
        protocol=protocol,
        registers={**table},
        table=lambda model: table,
        numbers={model.model_number: model.name.split("-")[0] for model in models},
        models=models,
        bauds=bauds,
        state=blocks[0],
        health=blocks[1],
        check=blocks[2],
        required=lambda model: required,
        gain=lambda model: gain,
        alert=sum(1 << bit for bit in errors),
        errors=errors,
        shutdown="shutdown",
        torque_bytes=_unlike(block.size for block in blocks),
        emulation=emulation,
    )


def _blocks(name: str, table: RegisterTable) -> tuple[Block, Block, Block]:
    """Return the reads of the state; from there to voltage and temperature; and from torque on.

    Raises:
        ValueError: The registers are not in this order.
    """
    effort = next((each for each in EFFORTS if each in table), EFFORTS[-1])
    state = (
        _register(name, table, "present_position"),
        _register(name, table, "present_velocity"),
        _register(name, table, effort),
    )
    health = [_register(name, table, each) for each in ("present_voltage", "present_temperature")]
    torque = _register(name, table, "torque_enable")
    begin = min(register.address for register in state)
    if torque.address >= begin or min(register.address for register in health) < begin:
        raise ValueError(
            f"family {name!r}: torque_enable has to be below the registers of position, velocity "
            "and load, and voltage and temperature above them; make a Family with blocks of its own"
        )
    end = max(register.address + register.size for register in (*state, *health))
    short = max(register.address + register.size for register in state)
    return (
        Block(begin, short - begin, state),
        Block(begin, end - begin, state),
        Block(torque.address, end - torque.address, state),
    )


def _register(name: str, table: RegisterTable, register: str) -> Register:
    if register not in table:
        raise ValueError(f"family {name!r} has no register {register}")
    return table[register]


def _unlike(sizes: Iterable[int]) -> int:
    """Return a number of bytes in which no other read has its answer."""
    taken = {*SINGLE, *sizes}
    return next(size for size in count(1) if size not in taken)
