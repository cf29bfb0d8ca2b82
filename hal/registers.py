"""A register of a servo: where it is, how it is signed, and what one count of it means."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

from hal.errors import UnknownNameError

Area = Literal["eeprom", "ram"]


@dataclass(frozen=True, slots=True)
class Register:
    """One register, little-endian, two's complement where it is signed.

    Attributes:
        name: As in the maker's manual, in lower case.
        address: Of the first byte.
        size: Bytes.
        area: An "eeprom" register is locked while torque is on, and wears.
        writable: Can it be written at all?
        signed: Are negative counts possible?
        unit: SI value of one count: rad, rad/s, A, V, s, or a fraction of 1.
    """

    name: str
    address: int
    size: int
    area: Area = "ram"
    writable: bool = True
    signed: bool = False
    unit: float = 1.0

    def decode(self, data: bytes) -> int:
        """Return the counts that `data` spells."""
        return int.from_bytes(data, "little", signed=self.signed)

    def encode(self, counts: int) -> bytes:
        """Return the bytes of `counts`.

        Raises:
            OverflowError: They do not fit.
        """
        return counts.to_bytes(self.size, "little", signed=self.signed)


class RegisterTable(Mapping[str, Register]):
    """The registers of one type of servo, by name; an unknown name lists the likely one."""

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
