"""A servo's control table in memory: items, access rules, indirect addresses, resets."""

from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

OK: Final = 0x00
FAILED: Final = 0x01
BAD_INSTRUCTION: Final = 0x02
BAD_CRC: Final = 0x03
BAD_RANGE: Final = 0x04
BAD_LENGTH: Final = 0x05
BAD_LIMIT: Final = 0x06
BAD_ACCESS: Final = 0x07

MASKS: Final = {1: 0xFF, 2: 0xFFFF, 4: 0xFFFFFFFF}
EEPROM_END = 64  # items below this address survive a reboot


class TableItem(NamedTuple):
    """One item of a control table.

    Attributes:
        address: First byte.
        size: 1, 2 or 4 bytes, little-endian.
        name: The manual's name in snake case.
        access: "R" or "RW".
        default: Value after a factory reset (EEPROM) or a reboot (RAM).
        low: Smallest value that may be written; below zero means two's complement.
        high: Largest value that may be written.
    """

    address: int
    size: int
    name: str
    access: str = "R"
    default: int = 0
    low: int = 0
    high: int = 0

    @property
    def signed(self) -> bool:
        """Whether the value is two's complement."""
        return self.low < 0

    @property
    def end(self) -> int:
        """The address after the item."""
        return self.address + self.size


class IndirectAddresses(NamedTuple):
    """A run of indirect addresses (two bytes each) and the data bytes that they map."""

    address: int
    data: int
    slots: int


class RegisterFile:
    """Bytes of one control table, with the rules by which a host may read and write them.

    A write that covers several items is checked as a whole and executed as a whole. Gaps between
    items read as zero. An indirect data byte has the properties of the byte that it points to.
    """

    def __init__(
        self, items: Sequence[TableItem], indirect: Sequence[IndirectAddresses] = ()
    ) -> None:
        slots = [
            TableItem(run.address + 2 * k, 2, f"indirect_address_{run.address + 2 * k}", "RW",
                 run.data + k, EEPROM_END, max(r.data + r.slots for r in indirect) - 1)
            for run in indirect
            for k in range(run.slots)
        ]  # fmt: skip
        cells = [
            TableItem(run.data + k, 1, f"indirect_data_{run.data + k}", "RW", 0, 0, 255)
            for run in indirect
            for k in range(run.slots)
        ]
        self.items = {item.name: item for item in (*items, *slots, *cells)}
        self.size = max(item.end for item in self.items.values())
        self.memory = bytearray(self.size)
        self._at: dict[int, TableItem] = {item.address: item for item in self.items.values()}
        self._defined = bytearray(self.size)
        for item in self.items.values():
            self._defined[item.address : item.end] = b"\1" * item.size
        self._slots = {
            run.data + k: run.address + 2 * k for run in indirect for k in range(run.slots)
        }
        self._slot_addresses = frozenset(self._slots.values())
        self._routes: dict[tuple[int, int], tuple[int, ...] | None] = {}
        self._plans: dict[tuple[int, int, bool], tuple[TableItem, ...] | int] = {}
        self._values: dict[str, int] = {}
        self.reset(self.items.values())

    # Access by the firmware: without rules.

    def get(self, name: str) -> int:
        """Return the value that an item was last set to."""
        return self._values[name]

    def set(self, name: str, value: int) -> None:
        """Set an item regardless of access rights and limits; the bytes wrap around its size."""
        self._store(self.items[name], value)

    def reset(self, items: Iterable[TableItem]) -> None:
        """Reset items to their defaults."""
        for item in items:
            self.set(item.name, item.default)
        self._forget()

    def eeprom(self) -> list[TableItem]:
        """Return the items that survive a reboot."""
        return [item for item in self.items.values() if item.address < EEPROM_END]

    def ram(self) -> list[TableItem]:
        """Return the items that a reboot resets."""
        return [item for item in self.items.values() if item.address >= EEPROM_END]

    # Access by the host: with rules.

    def read(self, address: int, count: int) -> bytes | None:
        """Return `count` bytes, or None if none of them is defined."""
        if count == 0 or address + count > self.size:
            return None
        route = self._route(address, count)
        if route is not None:
            return bytes([self.memory[place] for place in route])
        if not any(self._defined[address : address + count]):
            return None
        return bytes(self.memory[address : address + count])

    def touches(self, address: int, count: int, first: int, last: int) -> bool:
        """Return whether a read of `count` bytes covers addresses from `first` to `last`."""
        route = self._route(address, count)
        if route is not None:
            return any(first <= place <= last for place in route)
        return address <= last and first < address + count

    def check(
        self, address: int, data: bytes, locked: bool
    ) -> tuple[int, list[tuple[TableItem, int]]]:
        """Return the error of writing `data`, and the items with the values they would get.

        Args:
            address: First address.
            data: Bytes to write.
            locked: Whether torque is on, which locks the EEPROM.
        """
        key = (address, len(data), locked)
        plan = self._plans.get(key)
        if plan is None:
            plan = self._plan(*key)
            if len(self._plans) < 256:
                self._plans[key] = plan
        if isinstance(plan, int):
            return plan, []
        writes = []
        at = 0
        for item in plan:
            value = int.from_bytes(data[at : at + item.size], "little", signed=item.low < 0)
            if not item.low <= value <= item.high:
                return BAD_RANGE, []
            writes.append((item, value))
            at += item.size
        return OK, writes

    def _plan(self, address: int, count: int, locked: bool) -> tuple[TableItem, ...] | int:
        """Return the items that a write covers, or its error."""
        if count == 0 or address + count > self.size:
            return BAD_ACCESS
        places = self._route(address, count) or tuple(range(address, address + count))
        plan = []
        at = 0
        while at < count:
            item = self._at.get(places[at])
            if item is None:
                return BAD_LENGTH if self._defined[places[at]] else BAD_ACCESS
            if item.access != "RW" or (locked and item.address < EEPROM_END):
                return BAD_ACCESS
            if places[at : at + item.size] != tuple(range(item.address, item.end)):
                return BAD_LENGTH
            plan.append(item)
            at += item.size
        return tuple(plan)

    def commit(self, writes: Iterable[tuple[TableItem, int]]) -> None:
        """Execute writes that `check` has accepted."""
        for item, value in writes:
            self._store(item, value)
            if item.address in self._slot_addresses:
                self._forget()

    def _store(self, item: TableItem, value: int) -> None:
        """Store a value twice: as bytes for the host, as a number for the firmware."""
        address, size = item.address, item.size
        wrapped = value & MASKS[size]
        self.memory[address : address + size] = wrapped.to_bytes(size, "little")
        self._values[item.name] = value

    def _forget(self) -> None:
        self._routes.clear()
        self._plans.clear()

    def _route(self, address: int, count: int) -> tuple[int, ...] | None:
        """Return the addresses that `count` bytes map to, or None if none is indirect."""
        key = (address, count)
        try:
            return self._routes[key]
        except KeyError:
            pass
        seen = range(address, address + count)
        places = tuple(self._place(byte) for byte in seen)
        route = None if places == tuple(seen) else places
        if len(self._routes) < 64:
            self._routes[key] = route
        return route

    def _place(self, byte: int) -> int:
        slot = self._slots.get(byte)
        if slot is None:
            return byte
        return self.memory[slot] | self.memory[slot + 1] << 8
