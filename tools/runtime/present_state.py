"""The state of a robot that is up, published whenever it changes."""

from collections.abc import Callable
from typing import Final

from windup.hal.publishing.run_state import RunState
from windup.tools.robot.session import Session
from windup.tools.runtime.board import ARMED, STATE, Board

USUAL: Final = {
    "stride": RunState.WALKING,
    "step": RunState.STEPPING,
    "footprints": RunState.STEPPING,
    "rise": RunState.RISING,
}
"""State during a behaviour whose controller publishes none that says more than standing."""


class PresentState:
    """The state of a robot in the board.

    Args:
        session: The robot.
        board: The board.
        ring: Tells the broker that the state has changed.

    Attributes:
        off: Torque is off.
        faulted: That is because of an error.
    """

    def __init__(self, session: Session, board: Board, ring: Callable[[], None]) -> None:
        self._session, self._words, self._ring = session, board.words, ring
        self.off = self.faulted = False
        self._usual: RunState | None = None
        session.on_stop = self._stopping

    def begin(self, behaviour: str) -> None:
        """A behaviour begins."""
        self.off, self._usual = False, USUAL.get(behaviour, RunState.STANDING)

    def end(self) -> None:
        """The behaviour has ended."""
        self._usual = None

    def update(self) -> None:
        """Publish the state of this tick."""
        self.put(self._present())

    def put(self, state: RunState) -> None:
        """Publish a state."""
        words, torque = self._words, not self.off
        if words[STATE] != state or words[ARMED] != torque:
            words[STATE], words[ARMED] = state, torque
            self._ring()

    def _present(self) -> RunState:
        session = self._session
        if session.protected is not None and session.protected.active:
            return RunState.FALLEN if session.protected.finished else RunState.FALLING
        if self.off and session.fallen:
            return RunState.FALLEN
        if self.off:
            return RunState.FAULTED if self.faulted else RunState.LIMP
        if self._usual is None:
            return RunState.HOLDING
        writer = session.telemetry.writer
        if writer is None or writer.block.run_state is RunState.STANDING:
            return self._usual
        return RunState(writer.block.run_state)

    def _stopping(self) -> None:
        self.put(RunState.STOPPING)
