"""Servo registers: address, encoding, and the SI value of one count."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from windup.hal.errors import UnknownNameError

Area = Literal["eeprom", "ram"]
ByteOrder = Literal["little", "big"]


@dataclass(frozen=True, slots=True)
class Register:
    """One register. Byte order and sign encoding belong to the register, not to the bus.

    Attributes:
        name: As in the maker's manual, in lower case.
        address: Address of the first byte.
        size: Size, bytes.
        area: An "eeprom" register is locked while torque is on, and wears out with writes.
        writable: Whether it can be written.
        signed: Whether it is signed, in two's complement.
        unit: SI value of one count: rad, rad/s, A, V, s, or a fraction of 1.
        sign_bit: Bit that is set for negative values (sign-magnitude encoding), or None.
        order: Byte order.
    """

    name: str
    address: int
    size: int
    area: Area = "ram"
    writable: bool = True
    signed: bool = False
    unit: float = 1.0
    sign_bit: int | None = None
    order: ByteOrder = "little"

    @property
    def dtype(self) -> str:
        """The numpy type of its raw bytes."""
        return f"{'<' if self.order == 'little' else '>'}{'i' if self.signed else 'u'}{self.size}"

    def decode(self, data: bytes) -> int:
        """Return the value of the raw bytes `data`, counts."""
        raw = int.from_bytes(data, self.order, signed=self.signed)
        if self.sign_bit is None:
            return raw
        magnitude = raw & (1 << self.sign_bit) - 1
        return -magnitude if raw >> self.sign_bit & 1 else magnitude

    def encode(self, counts: int) -> bytes:
        """Return the raw bytes of the value `counts`.

        Raises:
            OverflowError: The value does not fit.
        """
        if self.sign_bit is not None:
            if abs(counts) >> self.sign_bit:
                raise OverflowError(f"{counts} does not fit into {self.name}")
            counts = -counts | 1 << self.sign_bit if counts < 0 else counts
        return counts.to_bytes(self.size, self.order, signed=self.signed)

    def values(self, raw: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return the values of an array of raw `dtype` words, counts."""
        if self.sign_bit is None:
            return raw
        return _magnitudes(self.sign_bit).take(raw)


@lru_cache(maxsize=8)
def _magnitudes(sign_bit: int) -> npt.NDArray[np.int32]:
    """Return the value of each 16-bit word as a table; a look-up takes a fifth of computing it."""
    raw = np.arange(1 << 16, dtype=np.int32)
    one = 1 << sign_bit
    magnitude = raw & one - 1
    table = np.where(raw & one, -magnitude, magnitude)
    table.setflags(write=False)
    return table


class RegisterTable(Mapping[str, Register]):
    """The registers of one servo model, by name; the error for an unknown name suggests one."""

    def __init__(self, model: str, registers: Iterable[Register]) -> None:
        self.model = model
        self._registers = {register.name: register for register in registers}

    def __getitem__(self, name: str) -> Register:
        try:
            return self._registers[name]
        except KeyError:
            raise UnknownNameError(f"register of the {self.model}", name, self) from None

    def __contains__(self, name: object) -> bool:
        return name in self._registers

    def __iter__(self) -> Iterator[str]:
        return iter(self._registers)

    def __len__(self) -> int:
        return len(self._registers)
