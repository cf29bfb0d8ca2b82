"""The state of a robot that is up, published whenever it changes."""

from collections.abc import Callable

from windup.hal.publishing.run_state import RunState
from windup.tools.robot.session import Session
from windup.tools.runtime.board import ARMED, STATE, Board


class PresentState:
    """The state of a robot in the board.

    Args:
        session: The robot.
        board: The board.
        ring: Tells the broker that the state has changed.

    Attributes:
        off: Torque is off.
        faulted: That is because of an error.
        behaves: A behaviour goes on; the telemetry has the state that its controller publishes.
    """

    def __init__(self, session: Session, board: Board, ring: Callable[[], None]) -> None:
        self._session, self._words, self._ring = session, board.words, ring
        self.off = self.faulted = self.behaves = False
        session.on_stop = self._stopping

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
        if not self.behaves:
            return RunState.HOLDING
        writer = session.telemetry.writer
        return RunState.STANDING if writer is None else RunState(writer.block.run_state)

    def _stopping(self) -> None:
        self.put(RunState.STOPPING)
