"""Stopping a robot whose program is gone: the policy on each bus until torque is read as off."""

import os
import time
from contextlib import suppress

from windup.hal.guardian.crouch import crouch
from windup.hal.guardian.held import hold
from windup.hal.guardian.host import Host
from windup.hal.guardian.order import Order
from windup.hal.guardian.remote_bus import RemoteBus
from windup.hal.guardian.words import Say
from windup.hal.in_words import in_words
from windup.hal.port.lock import Note, write_note

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
        say: Tells people, and never waits for them.
    """

    def __init__(self, order: Order, say: Say) -> None:
        self._order, self._tell = order, say
        # What cannot be has to come out now, not when it matters.
        self._buses = [RemoteBus(charge) for charge in order.charges]
        self._said = time.monotonic()
        self._trouble = ""
        self._note("")

    def carry_out(self, why: str, moved: bool = True) -> None:
        """Stop the servos; return when torque has been read as off, whatever goes wrong before.

        Args:
            why: That the host does not do it; new runs that wait for the adapters are told too.
            moved: The robot has made its first motion. Before, it does not crouch.
        """
        self._said, policy = time.monotonic(), self._order.policy
        self._say(f"{why} (process {self._order.host}); stopping its servos")
        try:
            self._note("switching the torque off")
            if policy == "hold":
                self._hold()
            elif policy == "crouch" and moved and all(bus.charge.crouch for bus in self._buses):
                self._crouch()
        except Exception as error:
            self._say(f"it cannot {policy} ({in_words(error)}); torque goes off")
        self.switch_off()

    def wait_for(self, host: Host) -> None:
        """Return when the host is gone, which might switch torque on until then."""
        while not host.wait(1.0):
            self._say(f"process {host.number} does not die; waiting for that")
            self.switch_off()

    def _hold(self) -> None:
        """Hold where the servos are for the order's time, as long as heat and supply allow."""
        seconds = self._order.hold
        for bus in self._buses:
            bus.stay()
        self._note("holding its pose")
        self._say(f"it holds its pose; torque goes off in {seconds:g} s")
        why = hold(self._buses, seconds) or f"{seconds:g} s are over"
        self._say(f"{why}; torque goes off")

    def _crouch(self) -> None:
        """Crouch if every joint can be read."""
        crouch(self._buses)
        self._say("it has crouched")

    def switch_off_once(self) -> list[str]:
        """Switch all torque off once; return the URLs of buses where it is not read as off."""
        left = [bus for bus in self._buses if not bus.switch_off()]
        self._trouble = "; ".join(f"{bus.charge.url}: {bus.trouble}" for bus in left)
        return [bus.charge.url for bus in left]

    def switch_off(self) -> None:
        """Switch torque off until all of it has been read as off, however long that takes."""
        began = time.monotonic()
        while self.switch_off_once():
            now = time.monotonic()
            with suppress(Exception):  # nothing ends this but torque that was read as off
                self._complain(now)
            time.sleep(min(PAUSES[0] + SLOWER * max(now - began - QUICK, 0.0), PAUSES[1]))
        self._say("torque is off at all servos, read back")

    def _complain(self, now: float) -> None:
        """Say now and then what is still not known to be off."""
        if now - self._said < SAY_AGAIN:
            return
        self._said = now
        what = f"torque is not known to be off, still trying ({self._trouble})"
        what = f"{what}; cut the servo power, then end this process: kill -9 {os.getpid()}"
        self._note(what)
        self._say(what)

    def _say(self, text: str) -> None:
        """Tell people what becomes of their robot, if that can be done."""
        with suppress(Exception):
            self._tell(text)

    def _note(self, doing: str) -> None:
        for charge in self._order.charges:
            if charge.lock >= 0:
                write_note(charge.lock, Note(os.getpid(), doing))
