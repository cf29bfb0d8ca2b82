"""The board: shared memory between the loop and the broker of a runtime.

Neither side waits for the other. The broker writes the newest goal and the orders; the loop reads
them once a tick, and writes its state and its reports. Native 64-bit words::

    word  0  magic and version              8  ticks
          1  number of joints               9  missed ticks
          2  goals written                 10  reports written
          3  orders written                11  reports read
          4  orders read                   12  goals read
          5  client with the lease, or 0   13  the loop is over
          6  state of the robot            32  the counters of `Count`
          7  torque is on

The goal is at byte 1024: its number, owner and CRC-32, its time (CLOCK_MONOTONIC, s) and n float64.
"""

import mmap
import os
import struct
import time
import zlib
from collections.abc import Sequence
from typing import Final, NamedTuple, Self

from windup.hal.errors import UsageError
from windup.tools.runtime.counts import Count
from windup.tools.runtime.text_queue import TextQueue

MAGIC: Final = int.from_bytes(b"WINDBO\x00\x01", "big")
MARK, JOINTS, GOALS, ORDERS, ORDERS_READ, LEASE, STATE, ARMED, TICKS, MISSED = range(10)
REPORTS, REPORTS_READ, GOALS_READ, OVER = 10, 11, 12, 13
COUNTERS, WORDS = 32, 64
GOAL_AT, ORDERS_AT, REPORTS_AT = 1024, 4096, 4096 + 8 * 16384
GOAL: Final = struct.Struct("=QQId")
SIZE: Final = REPORTS_AT + 4 * 262144
MOST_JOINTS: Final = (ORDERS_AT - GOAL_AT - GOAL.size) // 8


class ReadGoal(NamedTuple):
    """A goal as the loop reads it.

    Attributes:
        number: Its number, counted from 1.
        owner: Number of the client that gave it.
        time: When it came, s on CLOCK_MONOTONIC.
        position: The n goal positions, rad, as bytes of float64.
    """

    number: int
    owner: int
    time: float
    position: bytes


class Board:
    """The board, mapped; see `create` and `open`."""

    def __init__(self, descriptor: int) -> None:
        self.descriptor = descriptor
        self._map = mmap.mmap(descriptor, SIZE)
        self._view = memoryview(self._map)
        self.words = self._view[: 8 * WORDS].cast("Q")
        self.orders = TextQueue(self._map, self.words, ORDERS, ORDERS_READ, ORDERS_AT, 8, 16384)
        self.reports = TextQueue(
            self._map, self.words, REPORTS, REPORTS_READ, REPORTS_AT, 4, 262144
        )

    @classmethod
    def create(cls, joints: int) -> Self:
        """Create the board of a runtime, in memory without a name; a child inherits it.

        Raises:
            UsageError: The robot has too many joints, or there is no memory.
        """
        if joints > MOST_JOINTS:
            raise UsageError(f"a runtime takes at most {MOST_JOINTS} joints, not {joints}")
        try:
            descriptor = os.memfd_create("windup-board", os.MFD_CLOEXEC)
            os.posix_fallocate(descriptor, 0, SIZE)
        except OSError as error:
            raise UsageError(f"no memory for the runtime: {error.strerror}") from None
        board = cls(descriptor)
        board.words[JOINTS], board.words[MARK] = joints, MAGIC
        return board

    @classmethod
    def open(cls, descriptor: int) -> Self:
        """Map the board behind an inherited descriptor.

        Raises:
            ValueError: It is none of this version.
        """
        board = cls(descriptor)
        if board.words[MARK] != MAGIC:
            raise ValueError("no board of this version")
        return board

    def put_goal(self, position: Sequence[float]) -> None:
        """Replace the goal by (n,) rad, for the present owner of the lease."""
        payload = struct.pack(f"={len(position)}d", *position)
        number, now = self.words[GOALS] + 1, time.monotonic()
        if self.words[GOALS_READ] < number - 1:
            self.count(Count.REPLACED)
        start, owner = GOAL_AT + GOAL.size, self.words[LEASE]
        self._map[start : start + len(payload)] = payload
        GOAL.pack_into(self._map, GOAL_AT, number, owner, _check(number, owner, now, payload), now)
        self.words[GOALS] = number

    @property
    def newest(self) -> int:
        """Number of the newest goal; 0 before any."""
        return self.words[GOALS]

    def goal(self, after: int) -> ReadGoal | None:
        """Return the newest goal if its number is above `after`; None also while it is written."""
        if self.words[GOALS] <= after:
            return None
        number, owner, check, came = GOAL.unpack_from(self._map, GOAL_AT)
        start = GOAL_AT + GOAL.size
        payload = self._map[start : start + 8 * self.words[JOINTS]]
        if number <= after or check != _check(number, owner, came, payload):
            return None
        self.words[GOALS_READ] = number
        return ReadGoal(number, owner, came, payload)

    def count(self, what: Count, more: int = 1) -> None:
        """Count something; each counter is counted by one side only."""
        self.words[COUNTERS + what] += more

    def counts(self) -> dict[str, int]:
        """Return all counters by name."""
        return {what.words: self.words[COUNTERS + what] for what in Count}

    def close(self) -> None:
        """Release the memory and the descriptor."""
        self.words.release()
        self._view.release()
        self._map.close()
        os.close(self.descriptor)


def _check(number: int, owner: int, came: float, payload: bytes) -> int:
    return zlib.crc32(payload, zlib.crc32(struct.pack("=QQd", number, owner, came)))
