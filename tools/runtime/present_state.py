"""The state of a robot that is up, published whenever it changes."""

from collections.abc import Callable
from typing import Final

from windup.hal.publishing.run_state import RunState
from windup.tools.robot.session import Session
from windup.tools.runtime.board import ARMED, STATE, Board

STATES: Final = {
    "walk": RunState.WALKING,
    "stride": RunState.WALKING,
    "step": RunState.STEPPING,
    "footprints": RunState.STEPPING,
    "rise": RunState.RISING,
}
"""State of the robot while a behaviour goes on; `STANDING` for all others."""


class PresentState:
    """The state of a robot in the board.

    Args:
        session: The robot.
        board: The board.
        ring: Tells the broker that the state has changed.

    Attributes:
        doing: State while nothing happens to the robot: that of its behaviour, or holding.
        off: Torque is off.
    """

    def __init__(self, session: Session, board: Board, ring: Callable[[], None]) -> None:
        self._session, self._words, self._ring = session, board.words, ring
        self.doing, self.off = RunState.HOLDING, False
        session.on_stop = self._stopping

    def begin(self, behaviour: str) -> None:
        """A behaviour begins."""
        self.doing = STATES.get(behaviour, RunState.STANDING)

    def update(self) -> None:
        """Publish the state of this tick."""
        session = self._session
        if session.protected is not None and session.protected.active:
            state = RunState.FALLEN if session.protected.finished else RunState.FALLING
        elif self.off:
            limp = self.doing if self.doing is RunState.FAULTED else RunState.LIMP
            state = RunState.FALLEN if session.fallen else limp
        else:
            state = self.doing
        self.put(state)

    def put(self, state: RunState) -> None:
        """Publish a state."""
        words, torque = self._words, not self.off
        if words[STATE] != state or words[ARMED] != torque:
            words[STATE], words[ARMED] = state, torque
            self._ring()

    def _stopping(self) -> None:
        self.put(RunState.STOPPING)
