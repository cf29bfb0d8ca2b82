"""Holds an armed robot between two runs, while the program loads a file or waits for a key.

The servos receive no commands then and hold their last goals. A thread reads them, which checks
their state and feeds their bus watchdog, and sends heartbeats to the guardian. It never runs
concurrently with the loop: a run ends it before its first tick.
"""

import logging
import threading
from collections.abc import Callable

from windup.hal.errors import WindupError
from windup.hal.guard import GuardedBackend
from windup.hal.stopping.stop_flag import StopFlag
from windup.tools.stopping.interrupts import note_interruption
from windup.tools.stopping.stop_request import pressed_button, told_to_stop

GRACE_TIME = 0.2
"""Time for an interrupted program to end by itself, s."""
PERIOD = 0.04
"""Period of reading the servos, s; their bus watchdog has a time-out of 0.2 s."""


class IdleKeeper:
    """Holds a robot for a while, then switches its torque off; at once on a stop request.

    Args:
        backend: The robot.
        seconds: Longest time for which it is held, s.
        alive: Called periodically to send a heartbeat.
        give_up: Stops the robot; called in the thread with None when the time is over or a button
            was pressed, or with an error.
        flag: Stop flag of the program.
    """

    def __init__(
        self,
        backend: GuardedBackend,
        seconds: float,
        alive: Callable[[], None],
        give_up: Callable[[WindupError | None], None],
        flag: StopFlag | None = None,
    ) -> None:
        self._backend, self._seconds, self._flag = backend, seconds, flag
        self._alive, self._give_up = alive, give_up
        self._until, self._by = backend.clock.now() + seconds, ""
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._hold, name="windup-idle", daemon=True)
        self._thread.start()

    def interrupt(self, by: str) -> None:
        """Stop soon because of the signal `by`, unless the program starts a run before that."""
        self._by = self._by or by
        self._until = min(self._until, self._backend.clock.now() + GRACE_TIME)

    def end(self) -> None:
        """End the thread; the caller controls the robot from now on."""
        self._over.set()
        if self._thread is not threading.current_thread():
            self._thread.join()

    def _hold(self) -> None:
        clock = self._backend.clock
        try:
            while not self._over.wait(PERIOD):
                if clock.now() > self._until:
                    self._stop_robot()
                    return
                self._backend.read()
                self._alive()
                by = told_to_stop(self._flag) or pressed_button(self._backend.backend)
                if by is not None:
                    logging.getLogger(__name__).warning("stopped by %s", by)
                    note_interruption(by)
                    self._give_up(None)
                    return
        except WindupError as error:
            logging.getLogger(__name__).warning("%s; torque goes off", error)
            self._give_up(error)

    def _stop_robot(self) -> None:
        if self._by:
            logging.getLogger(__name__).warning("stopped by %s", self._by)
            self._give_up(None)
            return
        logging.getLogger(__name__).warning(
            "no command for %g s: torque goes off; where your program waits, call "
            "robot.stand(seconds), or set [safety] idle in robot.toml",
            self._seconds,
        )
        self._give_up(None)
