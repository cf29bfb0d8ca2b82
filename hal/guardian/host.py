"""The host process as watched by the guardian: detects its end, prints its stacks, kills it."""

import os
import select
import signal
from contextlib import suppress

from windup.hal.guardian.traceback_signal import WHERE

TRACEBACK_TIME = 0.02
"""Time granted to the host to print its stacks, s."""


class Host:
    """The host process, held by a pidfd, so that a reused process id is never mistaken for it.

    Args:
        number: Its process id.

    Raises:
        OSError: It exists but cannot be watched.

    Attributes:
        descriptors: Its pidfd, which becomes readable when it ends; empty if it has ended before.
    """

    def __init__(self, number: int) -> None:
        self.number = number
        self.descriptors: list[int] = []
        with suppress(ProcessLookupError):
            self.descriptors = [os.pidfd_open(number)]
        self._poll = select.poll()
        for descriptor in self.descriptors:
            self._poll.register(descriptor, select.POLLIN)

    @property
    def has_ended(self) -> bool:
        """True if the process has ended."""
        return self.wait(0.0)

    def wait(self, seconds: float) -> bool:
        """Wait at most `seconds` s for its end, and return whether it has ended."""
        if not self.descriptors:
            return True
        return bool(self._poll.poll(seconds * 1e3))

    def kill(self) -> None:
        """Make it print its stacks, then kill it, and wait `TRACEBACK_TIME` for its end.

        The time for printing is limited, because its output may not be read by anything.
        """
        self._send(WHERE)
        self.wait(TRACEBACK_TIME)
        self._send(signal.SIGKILL)
        self.wait(TRACEBACK_TIME)

    def _send(self, number: int) -> None:
        for descriptor in self.descriptors:
            with suppress(OSError):
                signal.pidfd_send_signal(descriptor, number)
