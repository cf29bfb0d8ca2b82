"""The process that a guardian watches: is it gone, where does it hang, and its end by force."""

import os
import select
import signal
from contextlib import suppress

from windup.hal.guardian.traceback_signal import WHERE

TRACEBACK_TIME = 0.02
"""What the host gets for printing where it hangs, s."""


class Host:
    """A process, by a descriptor that no other process can inherit the number of.

    Args:
        number: Its process number.

    Raises:
        OSError: It cannot be watched, though it is there.

    Attributes:
        descriptors: What becomes readable when it has ended; empty if it had ended before.
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
    def gone(self) -> bool:
        """True when it has ended."""
        return self.wait(0.0)

    def wait(self, seconds: float) -> bool:
        """Wait for its end for some time, s, and return whether it has ended."""
        if not self.descriptors:
            return True
        return bool(self._poll.poll(seconds * 1e3))

    def kill(self) -> None:
        """Let it print where it hangs, then end it by force and wait for that a moment.

        It has its time for the print whether somebody reads that or not.
        """
        self._send(WHERE)
        self.wait(TRACEBACK_TIME)
        self._send(signal.SIGKILL)
        self.wait(TRACEBACK_TIME)

    def _send(self, number: int) -> None:
        for descriptor in self.descriptors:
            with suppress(OSError):
                signal.pidfd_send_signal(descriptor, number)
