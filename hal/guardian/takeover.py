"""Stopping a robot whose program is gone: the policy on each bus until torque is read as off."""

import os
import sys
import time
from contextlib import suppress

from hal.errors import HardwareError
from hal.guardian.crouch import crouch
from hal.guardian.held import hold
from hal.guardian.host import Host
from hal.guardian.lock import Note, write_note
from hal.guardian.order import Order
from hal.guardian.remote_bus import RemoteBus

PAUSES = 2e-3, 1.0
"""Between two attempts, s: the first, and the longest."""
QUICK, SLOWER = 0.5, 0.03
"""How long attempts follow each other at the shortest pause, s, and how it grows then, s/s."""
SAY_AGAIN = 5.0
"""Between two lines about servos that do not obey, s."""


class Takeover:
    """What a guardian does once its host is gone.

    Args:
        order: What it was told.
    """

    def __init__(self, order: Order) -> None:
        self._order = order
        # What cannot be has to come out now, not when it matters.
        self._buses = [RemoteBus(charge) for charge in order.charges]
        self._said = time.monotonic()
        self._trouble = ""
        self._note("")

    def begin(self, why: str) -> None:
        """Say why it begins, also to new runs that wait for the adapters."""
        self._said = time.monotonic()
        self._note("switching the torque off")
        self._say(f"{why} (process {self._order.host}); stopping its servos")

    def carry_out(self, host: Host, *, wait_for_host: bool = True) -> None:
        """Stop the servos; return when torque has been read as off and the host is gone.

        Args:
            host: The process that was watched.
            wait_for_host: It has to be gone in the end; not if it gave up its ports itself.
        """
        if self._order.policy == "hold":
            self._hold()
        elif self._order.policy == "crouch" and all(bus.charge.crouch for bus in self._buses):
            self._crouch()
        self._off()
        while wait_for_host and not host.wait(1.0):
            self._say(f"process {host.number} does not die; waiting for that")
            self._off()

    def _hold(self) -> None:
        """Hold where the servos are for the order's time, as long as heat and supply allow."""
        seconds = self._order.hold
        try:
            for bus in self._buses:
                bus.stay()
            self._note("holding its pose")
            self._say(f"it holds its pose; torque goes off in {seconds:g} s")
            why = hold(self._buses, seconds) or f"{seconds:g} s are over"
            self._say(f"{why}; torque goes off")
        except HardwareError as error:
            self._say(f"it cannot hold ({error}); torque goes off")

    def _crouch(self) -> None:
        """Crouch if every joint can be read; whatever goes wrong, torque goes off at once."""
        try:
            crouch(self._buses)
            self._say("it has crouched")
        except HardwareError as error:
            self._say(f"no crouch ({error}); torque goes off")

    def switch_off_once(self) -> list[str]:
        """Switch all torque off once; return the URLs of buses where it is not read as off."""
        left = [bus for bus in self._buses if not bus.switch_off()]
        self._trouble = "; ".join(f"{bus.charge.url}: {bus.trouble}" for bus in left)
        return [bus.charge.url for bus in left]

    def _off(self) -> None:
        """Switch torque off until all of it has been read as off, however long that takes."""
        began = time.monotonic()
        while self.switch_off_once():
            now = time.monotonic()
            self._complain(now)
            time.sleep(min(PAUSES[0] + SLOWER * max(now - began - QUICK, 0.0), PAUSES[1]))
        self._say("torque is off at all servos, read back")

    def _complain(self, now: float) -> None:
        """Say now and then what is still not known to be off."""
        if now - self._said < SAY_AGAIN:
            return
        self._said = now
        what = f"torque is not known to be off, still trying ({self._trouble})"
        self._note(what)
        self._say(f"{what}; cut the servo power")

    def _note(self, doing: str) -> None:
        for charge in self._order.charges:
            if charge.lock >= 0:
                write_note(charge.lock, Note(os.getpid(), doing))

    def _say(self, text: str) -> None:
        """Tell the terminal, if it is still there."""
        with suppress(OSError, ValueError):
            sys.stderr.write(f"windup guardian: {text}\n")
            sys.stderr.flush()
