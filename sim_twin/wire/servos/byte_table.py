"""The control table of a protocol 1 servo: bytes, fields over them, and an EEPROM behind.

Unlike the X series, these servos let a host write any run of bytes, also half of a field.
"""

from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

TWOS: Final = 16  # two's complement, of two bytes


class Field(NamedTuple):
    """One field of a control table.

    Attributes:
        address: First byte.
        size: 1 or 2 bytes.
        name: The manual's name in snake case.
        access: "R" or "RW".
        default: Value as the servo leaves the factory.
        low: Smallest value that may be written.
        high: Largest value that may be written.
        sign: How a value below zero is written: 0 not at all, a bit's number that bit beside the
            magnitude, `TWOS` two's complement.
    """

    address: int
    size: int
    name: str
    access: str = "R"
    default: int = 0
    low: int = 0
    high: int = 0
    sign: int = 0

    @property
    def end(self) -> int:
        """The address behind the field."""
        return self.address + self.size

    def pack(self, value: int) -> int:
        """Return the bits of a value."""
        if value >= 0 or self.sign == 0:
            return value & 0xFFFF
        return value & 0xFFFF if self.sign == TWOS else -value | 1 << self.sign

    def unpack(self, bits: int) -> int:
        """Return the value of bits."""
        if self.sign == 0 or not bits >> min(self.sign, 15) & 1:
            return bits
        return bits - 0x10000 if self.sign == TWOS else -(bits & ~(1 << self.sign))


Writes = list[tuple[Field, int]]


class ByteTable:
    """The bytes of one servo.

    Args:
        fields: Its fields.
        eeprom_end: Fields below keep what was saved when the power goes.
        big: Whether fields of two bytes have the high one first.

    Attributes:
        fields: The fields by name.
        memory: The bytes.
        saved: What the EEPROM holds, by name.
    """

    def __init__(self, fields: Sequence[Field], eeprom_end: int, big: bool = False) -> None:
        self.fields = {field.name: field for field in fields}
        self.memory = bytearray(max(field.end for field in fields))
        self.saved = {f.name: f.default for f in fields if f.address < eeprom_end}
        self._order: Final = "big" if big else "little"
        self._values: dict[str, int] = {}
        self._plans: dict[tuple[int, int], tuple[tuple[Field, ...], bool]] = {}
        self.power_up()

    def power_up(self) -> None:
        """Take what was saved, and for the rest what the factory gave."""
        for field in self.fields.values():
            self.set(field.name, self.saved.get(field.name, field.default))

    def factory(self, keep: Iterable[str] = ()) -> None:
        """Save the factory's values, but for some."""
        for name in self.saved:
            if name not in keep:
                self.saved[name] = self.fields[name].default

    def get(self, name: str) -> int:
        """Return the value of a field."""
        return self._values[name]

    def set(self, name: str, value: int) -> None:
        """Give a field a value, whatever a host may do with it."""
        field = self.fields[name]
        bits = field.pack(value) & (1 << 8 * field.size) - 1
        self.memory[field.address : field.end] = bits.to_bytes(field.size, self._order)
        self._values[name] = value

    def save(self, name: str) -> None:
        """Keep a field's value for the next power-up, if it lies in the EEPROM."""
        if name in self.saved:
            self.saved[name] = self._values[name]

    def read(self, address: int, count: int) -> bytes:
        """Return `count` bytes; what is not there reads as zero."""
        return bytes(self.memory[address : address + count]).ljust(count, b"\0")

    def decode(self, address: int, data: bytes) -> tuple[Writes, bool]:
        """Return what a write would set, and whether it reaches nothing that is not writable."""
        fields, clean = self._plan(address, len(data))
        writes: Writes = []
        for field in fields:
            start = field.address - address
            if start >= 0 and start + field.size <= len(data):
                raw = data[start : start + field.size]
            else:  # half a field: the other half stays
                there = bytearray(self.memory[field.address : field.end])
                for k in range(field.size):
                    if 0 <= start + k < len(data):
                        there[k] = data[start + k]
                raw = bytes(there)
            writes.append((field, field.unpack(int.from_bytes(raw, self._order))))
        return writes, clean

    def _plan(self, address: int, count: int) -> tuple[tuple[Field, ...], bool]:
        """Return the writable fields that a write reaches, and whether it reaches only such."""
        key = (address, count)
        plan = self._plans.get(key)
        if plan is None:
            end = address + count
            touched = [f for f in self.fields.values() if f.address < end and address < f.end]
            mine = tuple(f for f in touched if f.access == "RW")
            reached = sum(min(f.end, end) - max(f.address, address) for f in mine)
            plan = self._plans[key] = (mine, reached == count)
        return plan
