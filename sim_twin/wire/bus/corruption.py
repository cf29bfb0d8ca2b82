"""Corruptions of the bytes of a status packet, with or without a valid checksum."""

import random
from collections.abc import Callable
from typing import Final, Protocol

IDS = 253
MOST = 3  # largest number of bytes that are added or removed


class Layout(Protocol):
    """Positions of the parts of a frame; see `windup.sim_twin.wire.bus.bus.WireProtocol`."""

    id_at: int
    length_at: int
    data_at: int
    tail: int

    def with_checksum(self, frame: bytes, /) -> bytes:
        """Return `frame` with the correct checksum."""
        ...


def corrupt_packet(kind: str, data: bytes, layout: Layout, rng: random.Random) -> bytes:
    """Return a status packet with one of the faults that change its bytes."""
    return _SPOIL[kind](data, layout, rng)


def _drop(data: bytes, layout: Layout, rng: random.Random) -> bytes:
    return b""


def _cut(data: bytes, layout: Layout, rng: random.Random) -> bytes:
    return data[: rng.randrange(len(data))]


def _noise(data: bytes, layout: Layout, rng: random.Random) -> bytes:
    return rng.randbytes(rng.randint(1, 8)) + data


def _twice(data: bytes, layout: Layout, rng: random.Random) -> bytes:
    return data + data


def _corrupt(data: bytes, layout: Layout, rng: random.Random) -> bytes:
    return _flip(data, rng.randrange(len(data)), rng)


def _wrong_length(data: bytes, layout: Layout, rng: random.Random) -> bytes:
    at = layout.length_at
    return _flip(data, at if at < len(data) else rng.randrange(len(data)), rng)


def _wrong_id(data: bytes, layout: Layout, rng: random.Random) -> bytes:
    at = layout.id_at if layout.id_at < len(data) else rng.randrange(len(data))
    return layout.with_checksum(_with(data, at, (data[at] + rng.randrange(1, IDS)) % IDS))


def _longer(data: bytes, layout: Layout, rng: random.Random) -> bytes:
    more = rng.randint(1, MOST)
    if layout.length_at >= len(data) or data[layout.length_at] + more > 0xFF:
        return data
    body = data[: -layout.tail] + rng.randbytes(more) + data[-layout.tail :]
    return layout.with_checksum(_with(body, layout.length_at, data[layout.length_at] + more))


def _shorter(data: bytes, layout: Layout, rng: random.Random) -> bytes:
    there = len(data) - layout.data_at - layout.tail
    if there <= 0:
        return data
    less = rng.randint(1, min(MOST, there))
    body = data[: -layout.tail - less] + data[-layout.tail :]
    return layout.with_checksum(_with(body, layout.length_at, data[layout.length_at] - less & 0xFF))


def _zeros(data: bytes, layout: Layout, rng: random.Random) -> bytes:
    there = max(len(data) - layout.data_at - layout.tail, 0)
    return layout.with_checksum(data[: layout.data_at] + bytes(there) + data[-layout.tail :])


def _jump(data: bytes, layout: Layout, rng: random.Random) -> bytes:
    end = len(data) - layout.tail
    if end <= layout.data_at:
        return data
    return layout.with_checksum(_flip(data, rng.randrange(layout.data_at, end), rng))


def _flip(data: bytes, at: int, rng: random.Random) -> bytes:
    """Return `data` with a different byte at index `at`."""
    return _with(data, at, data[at] ^ rng.randrange(1, 256))


def _with(data: bytes, at: int, byte: int) -> bytes:
    return data[:at] + bytes((byte,)) + data[at + 1 :]


_SPOIL: Final[dict[str, Callable[[bytes, Layout, random.Random], bytes]]] = {
    "drop": _drop,
    "corrupt": _corrupt,
    "cut": _cut,
    "noise": _noise,
    "wrong_id": _wrong_id,
    "wrong_length": _wrong_length,
    "longer": _longer,
    "shorter": _shorter,
    "zeros": _zeros,
    "jump": _jump,
    "twice": _twice,
}
