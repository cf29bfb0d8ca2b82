"""The stop flag of a run: a small file in shared memory by which any process stops its robot.

The run looks at one word each tick. A request is a time; it is carried out once the same time
stands in the word of finished requests, behind the outcome. All words are native 64-bit integers,
each written by one side only::

    word  0  magic and version             4  newest request, CLOCK_MONOTONIC ns  (who stops)
          1  process id of the run         5  newest request seen                 (the run)
          2  start of that process         6  newest request carried out          (run, guardian)
          3  process id of its guardian    7  length of the outcome, bytes
                                           8  length of the description, bytes

The description is at byte 128, the outcome at byte 2048; both are JSON.
"""

import mmap
import os
import re
import time
from contextlib import suppress
from pathlib import Path
from typing import Final, Self

import msgspec

from windup.hal.errors import UsageError
from windup.hal.stopping.folder import private_folder
from windup.hal.stopping.process_start import process_start

MAGIC: Final = int.from_bytes(b"WINDST\x00\x01", "big")
WORDS: Final = 9
MARK, PID, START, GUARDIAN, ASKED, SEEN, DONE, OUTCOME, ABOUT = range(WORDS)
ABOUT_AT, OUTCOME_AT, SIZE = 128, 2048, 16384
SUFFIX = ".stop"
TIME_TO_ANSWER: Final = 100_000_000
"""Longest time for a run to see a request, ns; after that its guardian stops the robot."""


class About(msgspec.Struct, frozen=True):
    """What a run is about: name of its robot, and its port, None for a twin."""

    robot: str
    port: str | None = None


class Outcome(msgspec.Struct, frozen=True, kw_only=True):
    """What became of a stop.

    Attributes:
        said: The outcome, for people.
        stopped: The stop policy has been carried out.
        still_on: Names of joints whose torque was read back as on.
        unknown: Names of joints whose torque could not be read back.
        by: Who stopped the robot.
    """

    said: str
    stopped: bool = True
    still_on: tuple[str, ...] = ()
    unknown: tuple[str, ...] = ()
    by: str = "run"


class StopFlag:
    """A stop flag, of the run itself or as seen by another process; see `create` and `open`."""

    def __init__(self, path: Path, size: int = 0) -> None:
        self.path = path
        flags = os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW
        descriptor = os.open(path, flags | (os.O_CREAT | os.O_EXCL if size else 0), 0o600)
        try:
            if size:
                os.posix_fallocate(descriptor, 0, size)
            elif os.fstat(descriptor).st_size != SIZE:
                raise ValueError("other size")
            self._map = mmap.mmap(descriptor, SIZE)
        finally:
            os.close(descriptor)
        self._words = memoryview(self._map)[: 8 * WORDS].cast("Q")

    @classmethod
    def create(cls, robot: str, port: str | None = None, folder: Path | None = None) -> Self:
        """Create the flag of this process for a robot.

        Raises:
            UsageError: The file cannot be created.
        """
        folder = private_folder() if folder is None else folder
        remove_leftovers(folder)
        plain = re.sub(r"[^A-Za-z0-9_-]", "_", robot)
        number = 0
        while True:
            path = folder / f"{plain}.{os.getpid()}.{number}{SUFFIX}"
            try:
                flag = cls(path, SIZE)
                break
            except FileExistsError:
                number += 1
            except OSError as error:
                raise UsageError(f"{path} cannot be made: {error.strerror}") from None
        flag._describe(About(robot, port))
        return flag

    @classmethod
    def open(cls, path: Path) -> Self | None:
        """Open the flag of another process; None if there is none of this version at `path`."""
        try:
            flag = cls(path)
        except (OSError, ValueError):
            return None
        if flag._words[MARK] == MAGIC:
            return flag
        flag.close()
        return None

    def _describe(self, about: About) -> None:
        text = msgspec.json.encode(about)[: OUTCOME_AT - ABOUT_AT]
        self._map[ABOUT_AT : ABOUT_AT + len(text)] = text
        self._words[ABOUT] = len(text)
        self._words[PID], self._words[START] = os.getpid(), process_start(os.getpid())
        self._words[MARK] = MAGIC

    @property
    def pid(self) -> int:
        """Process id of the run."""
        return self._words[PID]

    @property
    def alive(self) -> bool:
        """True while the process of the run exists."""
        return process_start(self._words[PID]) == self._words[START]

    @property
    def guardian(self) -> int:
        """Process id of the run's guardian while torque may be on; 0 without one."""
        return self._words[GUARDIAN]

    @guardian.setter
    def guardian(self, pid: int) -> None:
        self._words[GUARDIAN] = pid

    @property
    def about(self) -> About:
        """What the run is about."""
        text = self._map[ABOUT_AT : ABOUT_AT + self._words[ABOUT]]
        return msgspec.json.decode(text, type=About)

    def request(self) -> int:
        """Request a stop; return its time stamp, ns."""
        stamp = time.monotonic_ns()
        self._words[ASKED] = stamp
        return stamp

    def asked(self) -> bool:
        """Return whether there is a request that is not carried out yet; it then counts as seen."""
        words = self._words
        if (stamp := words[ASKED]) == words[DONE]:
            return False
        words[SEEN] = stamp
        return True

    def again(self) -> bool:
        """Return whether a further request has come since one was seen: no time for a crouch."""
        return self._words[ASKED] > self._words[SEEN]

    def overdue(self, since: int = 0) -> bool:
        """Return whether the run has left its first unfinished request unseen for too long.

        Args:
            since: Time from which the run is expected to look, CLOCK_MONOTONIC, ns.
        """
        words = self._words
        stamp, done = words[ASKED], words[DONE]
        if stamp <= done or words[SEEN] > done:
            return False
        return time.monotonic_ns() - max(stamp, since) > TIME_TO_ANSWER

    def finish(self, outcome: Outcome) -> None:
        """Report that the requests so far are carried out, and what became of them."""
        words = self._words
        stamp = words[ASKED]
        text = msgspec.json.encode(outcome)[: SIZE - OUTCOME_AT]
        self._map[OUTCOME_AT : OUTCOME_AT + len(text)] = text
        words[OUTCOME] = len(text)
        words[DONE] = stamp

    def seen(self, stamp: int) -> bool:
        """Return whether the run has seen the request with this stamp, or a later one."""
        return self._words[SEEN] >= stamp or self.done(stamp)

    def done(self, stamp: int) -> bool:
        """Return whether the request with this stamp, or a later one, is carried out."""
        return self._words[DONE] >= stamp

    @property
    def outcome(self) -> Outcome | None:
        """What became of the last stop; None before any."""
        if not self._words[OUTCOME]:
            return None
        text = self._map[OUTCOME_AT : OUTCOME_AT + self._words[OUTCOME]]
        return msgspec.json.decode(text, type=Outcome)

    def close(self) -> None:
        """Release the memory."""
        self._words.release()
        self._map.close()

    def remove(self) -> None:
        """Remove the file, unless a guardian goes on with it, and release the memory."""
        if self.guardian == 0 or not process_start(self.guardian):
            if self.asked():
                self.finish(Outcome(said="the run has ended by itself; its torque is off"))
            with suppress(OSError):
                self.path.unlink()
        self.close()


def flags_in(folder: Path) -> list[StopFlag]:
    """Return the stop flags in a folder, opened."""
    found = (StopFlag.open(path) for path in sorted(folder.glob(f"*{SUFFIX}")))
    return [flag for flag in found if flag is not None]


def remove_leftovers(folder: Path) -> None:
    """Remove the flags of runs that have died, and whose guardian is gone."""
    for flag in flags_in(folder):
        if flag.alive or process_start(flag.guardian):
            flag.close()
        else:
            flag.remove()
