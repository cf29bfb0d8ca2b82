"""Holding an armed robot between two runs: a program may load a file, think, or wait for a key.

Nobody commands the servos then; they hold their last goals. A thread reads them, so that their
state is judged and their bus watchdog fed, and tells the guardian that the program is alive. It
never runs beside the loop: a run ends it before its first tick.
"""

import logging
import threading
from collections.abc import Callable

from windup.hal.errors import WindupError
from windup.hal.guard import GuardedBackend
from windup.tools.stopping.interrupts import note_interruption
from windup.tools.stopping.stop_request import pressed_button

LEAVE = 0.2
"""What an interrupted program is given to end by itself, s."""
PERIOD = 0.04
"""Between two looks at the servos, s; their bus watchdog waits for 0.2 s."""


class IdleKeeper:
    """Holds a robot for a while, then switches its torque off; at once when a button asks for it.

    Args:
        backend: The robot.
        seconds: How long it is held, s.
        alive: Called again and again: this process lives.
        give_up: Stops the robot; called in the thread when the time is over (None), or with what
            went wrong.
    """

    def __init__(
        self,
        backend: GuardedBackend,
        seconds: float,
        alive: Callable[[], None],
        give_up: Callable[[WindupError | None], None],
    ) -> None:
        self._backend, self._seconds = backend, seconds
        self._alive, self._give_up = alive, give_up
        self._until, self._by = backend.clock.now() + seconds, ""
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._hold, name="windup-idle", daemon=True)
        self._thread.start()

    def interrupt(self, by: str) -> None:
        """The program was interrupted, by whom in words: unless it takes the robot, it stops."""
        self._by = self._by or by
        self._until = min(self._until, self._backend.clock.now() + LEAVE)

    def end(self) -> None:
        """End the thread; the caller has the robot from now on."""
        self._over.set()
        if self._thread is not threading.current_thread():
            self._thread.join()

    def _hold(self) -> None:
        clock = self._backend.clock
        try:
            while not self._over.wait(PERIOD):
                if clock.now() > self._until:
                    self._let_go()
                    return
                self._backend.read()
                self._alive()
                if (button := pressed_button(self._backend.backend)) is not None:
                    logging.getLogger(__name__).warning("stopped by %s", button)
                    note_interruption(button)
                    self._give_up(None)
                    return
        except WindupError as error:
            logging.getLogger(__name__).warning("%s; torque goes off", error)
            self._give_up(error)

    def _let_go(self) -> None:
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
