"""The control table of a protocol 1 servo: bytes, fields and saved EEPROM values.

Unlike the X series, these servos accept a write of any run of bytes, also of half a field.
"""

from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

TWOS: Final = 16  # `Field.sign` of two bytes in two's complement


class Field(NamedTuple):
    """One field of a control table.

    Attributes:
        address: First byte.
        size: 1 or 2 bytes.
        name: The manual's name in snake case.
        access: "R" or "RW".
        default: Factory default.
        low: Smallest value that may be written.
        high: Largest value that may be written.
        sign: Encoding of negative values: 0 none, a bit number for a sign bit with magnitude,
            `TWOS` for two's complement.
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
        """The address after the field."""
        return self.address + self.size

    def pack(self, value: int) -> int:
        """Encode a value as bits."""
        if value >= 0 or self.sign == 0:
            return value & 0xFFFF
        return value & 0xFFFF if self.sign == TWOS else -value | 1 << self.sign

    def unpack(self, bits: int) -> int:
        """Decode a value from bits."""
        if self.sign == 0 or not bits >> min(self.sign, 15) & 1:
            return bits
        return bits - 0x10000 if self.sign == TWOS else -(bits & ~(1 << self.sign))


Writes = list[tuple[Field, int]]


class ByteTable:
    """The control table of one servo.

    Args:
        fields: The fields.
        eeprom_end: Fields below this address keep their saved values without power.
        big: Whether two-byte fields have the high byte first.

    Attributes:
        fields: The fields by name.
        memory: The bytes.
        saved: Values in the EEPROM, by name.
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
        """Load the saved values, and the factory defaults of all other fields."""
        for field in self.fields.values():
            self.set(field.name, self.saved.get(field.name, field.default))

    def reset_to_factory(self, keep: Iterable[str] = ()) -> None:
        """Save the factory defaults, except of the fields in `keep`."""
        for name in self.saved:
            if name not in keep:
                self.saved[name] = self.fields[name].default

    def get(self, name: str) -> int:
        """Return the value of a field."""
        return self._values[name]

    def set(self, name: str, value: int) -> None:
        """Set a field regardless of access rights and limits."""
        field = self.fields[name]
        bits = field.pack(value) & (1 << 8 * field.size) - 1
        self.memory[field.address : field.end] = bits.to_bytes(field.size, self._order)
        self._values[name] = value

    def save(self, name: str) -> None:
        """Save a field's value for the next power-up, if it is in the EEPROM."""
        if name in self.saved:
            self.saved[name] = self._values[name]

    def read(self, address: int, count: int) -> bytes:
        """Return `count` bytes; bytes beyond the table read as zero."""
        return bytes(self.memory[address : address + count]).ljust(count, b"\0")

    def decode(self, address: int, data: bytes) -> tuple[Writes, bool]:
        """Return the fields that a write would set, and whether it covers writable bytes only."""
        fields, clean = self._plan(address, len(data))
        writes: Writes = []
        for field in fields:
            start = field.address - address
            if start >= 0 and start + field.size <= len(data):
                raw = data[start : start + field.size]
            else:  # half a field: the other half keeps its value
                there = bytearray(self.memory[field.address : field.end])
                for k in range(field.size):
                    if 0 <= start + k < len(data):
                        there[k] = data[start + k]
                raw = bytes(there)
            writes.append((field, field.unpack(int.from_bytes(raw, self._order))))
        return writes, clean

    def _plan(self, address: int, count: int) -> tuple[tuple[Field, ...], bool]:
        """Return the writable fields that a write covers, and whether it covers only such."""
        key = (address, count)
        plan = self._plans.get(key)
        if plan is None:
            end = address + count
            touched = [f for f in self.fields.values() if f.address < end and address < f.end]
            mine = tuple(f for f in touched if f.access == "RW")
            reached = sum(min(f.end, end) - max(f.address, address) for f in mine)
            plan = self._plans[key] = (mine, reached == count)
        return plan
