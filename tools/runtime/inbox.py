"""What the loop reads from the board once a tick, and what it wants to do because of that."""

from collections.abc import Callable
from typing import Final

import msgspec

from windup.control.limit_cycle.balancer import Balancer
from windup.hal.errors import UsageError, WindupError
from windup.hal.observation import Observation
from windup.hal.publishing.run_state import RunState
from windup.tools.remote.messages import Change, Down, End, Ended, Refused, Run, Started
from windup.tools.robot.session import Session
from windup.tools.runtime.board import LEASE, MISSED, STATE, TICKS, Board
from windup.tools.runtime.live_walk import LiveWalk
from windup.tools.runtime.orders import ORDERS, Order, Report
from windup.tools.runtime.present_state import PresentState

FINISHING: Final = {"rise", "stride", "step", "footprints"}
"""Behaviours that come to their end by themselves: in the middle of a step nobody can be held."""
NOBODY: Final = 0
"""In place of a client's number."""


class Inbox:
    """Reads the orders of clients in the loop, without waiting.

    Args:
        session: The robot.
        board: The board that is shared with the broker.
        ring: Tells the broker that something stands in the board.
        state: The state of the robot.

    Attributes:
        client: The client whose behaviour goes on, or `NOBODY`.
        next: The behaviour that is to follow.
        down: The runtime is to go down.
    """

    def __init__(
        self, session: Session, board: Board, ring: Callable[[], None], state: PresentState
    ) -> None:
        self._session, self._state, self._ring = session, state, ring
        self._board, self._words = board, board.words
        self.client, self.down = NOBODY, False
        self.next: Order | None = None
        self._ending = ""
        self._finishes = False
        self._walk: LiveWalk | None = None

    def begin(self, client: int, behaviour: str) -> None:
        """A behaviour of a client begins."""
        self.client, self._ending, self._walk = client, "", None
        self._finishes = behaviour in FINISHING

    def end(self) -> None:
        """The behaviour has ended."""
        self.client, self._ending, self._walk = NOBODY, "", None

    def go_down(self) -> None:
        """End the behaviour, and then the runtime."""
        self.down, self._ending = True, "ended because the runtime goes down"

    def drop(self, why: str) -> None:
        """Refuse the behaviours that wait: they were ordered before torque went off."""
        self.read()
        order, self.next = self.next, None
        if order is not None and isinstance(order.message, Run):
            self.report(order.client, Refused(message=why, id=order.message.id))

    def look(self, observation: Observation) -> None:
        """Look into the board, in every tick."""
        words = self._words
        words[TICKS] += 1
        words[MISSED] = self._session.slowness.missed + self._session.loop.missed
        self._state.update()
        if self._board.orders.waiting:
            self.read()
        if self.client and words[LEASE] != self.client:
            self._ending = self._ending or "ended because its client has gone"

    def ordered(self, observation: Observation) -> str | None:
        """Return a reason to hold the robot no longer, or None."""
        return "ordered" if self.next is not None or self.down else None

    def broken_off(self, observation: Observation) -> str | None:
        """Return why the behaviour is to end now: it stands, or its walk has come to rest."""
        if not self._ending or not self.client:
            return None
        if (walk := self._live_walk()) is not None:
            return self._ending if walk.come_to_rest() else None
        stands = self._words[STATE] in (RunState.STANDING, RunState.HOLDING)
        return self._ending if stands and not self._finishes else None

    def report(self, client: int, message: Started | Ended | Refused) -> None:
        """Tell a client something; without a client, whoever sits at the runtime's terminal."""
        self._board.reports.put(msgspec.json.encode(Report(client, message)))
        self._ring()

    def read(self) -> None:
        """Read the orders that are waiting."""
        while (text := self._board.orders.take()) is not None:
            order = ORDERS.decode(text)
            message = order.message
            if isinstance(message, Run):
                if self.next is not None and isinstance(self.next.message, Run):
                    said = f"{message.behaviour} was ordered after it"
                    refused = Refused(message=said, id=self.next.message.id)
                    self.report(self.next.client, refused)
                self.next, self._ending = order, f"ended because {message.behaviour} follows"
            elif isinstance(message, End):
                self._ending = "ended by its client"
            elif isinstance(message, Down):
                self.go_down()
            else:
                self._change(order.client, message)

    def _change(self, client: int, change: Change) -> None:
        """Change the walk that goes on."""
        try:
            if (walk := self._live_walk()) is None:
                raise UsageError("nothing walks; speed, side, turn and style are of a walk")
            walk.change(change)
        except WindupError as error:
            self.report(client, Refused(message=str(error), exit_status=error.exit_status))

    def _live_walk(self) -> LiveWalk | None:
        """Return the walk that goes on, or None."""
        controller = self._session.controller
        walker = getattr(controller, "walker", controller)  # behind what catches pushes
        if not isinstance(walker, Balancer):
            return None
        if self._walk is None or self._walk.walker is not walker:
            self._walk = LiveWalk(walker)
        return self._walk
