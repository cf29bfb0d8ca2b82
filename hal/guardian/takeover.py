"""Takeover: carries out the stop policy after the host died, until torque is read back as off."""

import os
import time
from contextlib import suppress

from windup.hal.error_text import error_text
from windup.hal.guardian.crouch import crouch
from windup.hal.guardian.hold import hold
from windup.hal.guardian.host import Host
from windup.hal.guardian.message_writer import WriteLine
from windup.hal.guardian.order import GuardianOrder
from windup.hal.guardian.remote_bus import RemoteBus
from windup.hal.port.lock import LockNote, write_note
from windup.hal.stopping.stop_flag import Outcome, StopFlag

PAUSES = 2e-3, 1.0
"""Pause between two attempts to switch torque off, s: initial and maximum."""
QUICK, SLOWER = 0.5, 0.03
"""Time for which attempts use the initial pause, s, and the growth of the pause after that, s/s."""
OFF = "torque is off at all servos, read back"
MESSAGE_PERIOD = 5.0
"""Time between two messages about servos whose torque is not off, s."""


class Takeover:
    """Stops the robot after its host died or was killed.

    Args:
        order: The guardian's order.
        write_line: Writes a message without blocking.
        flag: The host's stop flag, in which the result of the stop is reported.
    """

    def __init__(
        self, order: GuardianOrder, write_line: WriteLine, flag: StopFlag | None = None
    ) -> None:
        self._order, self._write_line, self._flag = order, write_line, flag
        # Built now, so that an invalid order fails at the start and not during a takeover.
        self._buses = [RemoteBus(record) for record in order.buses]
        self._said = time.monotonic()
        self._trouble = ""
        self._note("")

    def carry_out(self, why: str, moved: bool = True) -> None:
        """Carry out the stop policy; return when torque has been read back as off.

        Any failure of the policy leads to torque off.

        Args:
            why: Why the host does not stop the robot itself, for messages.
            moved: The first motion after torque enable is complete; else it does not crouch.
        """
        self._said, policy = time.monotonic(), self._order.policy
        self._say(f"{why} (process {self._order.host}); stopping its servos")
        try:
            self._note("switching the torque off")
            if policy == "hold":
                self._hold()
            elif policy == "crouch" and moved and all(bus.record.crouch for bus in self._buses):
                self._crouch()
        except Exception as error:
            self._say(f"cannot {policy} ({error_text(error)}); torque goes off")
        self.switch_off()

    def wait_for(self, host: Host) -> None:
        """Wait until the host has ended, and keep torque off: the host might switch it on."""
        while not host.wait(1.0):
            self._say(f"process {host.number} has been killed but has not ended; waiting for it")
            self.switch_off()

    def _hold(self) -> None:
        """Hold the present pose for `hold` s of the order, if temperature and supply allow it."""
        seconds = self._order.hold
        for bus in self._buses:
            bus.hold_position()
        self._note("holding its pose")
        self._say(f"the robot holds its pose; torque goes off in {seconds:g} s")
        why = hold(self._buses, seconds) or f"{seconds:g} s have passed"
        self._say(f"{why}; torque goes off")

    def _crouch(self) -> None:
        """Crouch; fails if a joint cannot be read."""
        crouch(self._buses)
        self._say("the crouch is complete")

    def switch_off_once(self) -> list[str]:
        """Switch torque off once; return the URLs of the buses where it is not read as off."""
        left = [bus for bus in self._buses if not bus.switch_off()]
        self._trouble = "; ".join(f"{bus.record.url}: {bus.trouble}" for bus in left)
        return [bus.record.url for bus in left]

    def switch_off(self) -> None:
        """Switch torque off repeatedly until it is read back as off at all servos."""
        began = time.monotonic()
        while self.switch_off_once():
            now = time.monotonic()
            with suppress(Exception):  # a failing message must not end the attempts
                self._report_trouble(now)
            time.sleep(min(PAUSES[0] + SLOWER * max(now - began - QUICK, 0.0), PAUSES[1]))
        self._say(OFF)
        if self._flag is not None:
            self._flag.finish(Outcome(said=OFF, by="guardian"))

    def _report_trouble(self, now: float) -> None:
        """Report every `MESSAGE_PERIOD` s which torque is not known to be off."""
        if now - self._said < MESSAGE_PERIOD:
            return
        self._said = now
        what = f"torque is not known to be off, still trying ({self._trouble})"
        what = f"{what}; cut the servo power, then end this process: kill -9 {os.getpid()}"
        self._note(what)
        self._say(what)

    def _say(self, text: str) -> None:
        """Write a message; a failure to write is ignored."""
        with suppress(Exception):
            self._write_line(text)

    def _note(self, doing: str) -> None:
        for record in self._order.buses:
            if record.lock >= 0:
                write_note(record.lock, LockNote(os.getpid(), doing))
