"""A runtime in this process, on simulated time, whose client is a generator of a test."""

from collections.abc import Callable, Iterator
from typing import Any, cast

import msgspec

from windup.hal.observation import Observation
from windup.hal.publishing.run_state import RunState
from windup.tools.remote.messages import Change, Down, End, Ended, Refused, Run, Started
from windup.tools.robot.robot import Robot
from windup.tools.runtime.board import LEASE, STATE, Board
from windup.tools.runtime.orders import REPORTS, Order
from windup.tools.runtime.owner import Owner
from windup.tools.runtime.start_broker import BrokerProcess

ME = 1
"""Number of the client."""
Script = Iterator[Callable[[], bool]]
"""A client: it is continued in the first tick in which what it has yielded returns true."""


class NoBroker:
    """A broker that is not needed, because its client is in this process."""

    alive = True

    def ring(self) -> None:
        """Do nothing."""


class Scripted:
    """A runtime with one client.

    Attributes:
        robot: The robot.
        board: The board.
        told: What the client was told, in order.
        states: The states of the robot, in order.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot, self.board = robot, Board.create(len(robot.joints))
        self.told: list[Started | Ended | Refused] = []
        self.states: list[RunState] = []
        self._numbers = 0
        self._script: Script = iter(())
        self._until: Callable[[], bool] = lambda: True
        self.owner = Owner(robot, self.board, cast(BrokerProcess, NoBroker()))
        robot.session.watch.append(self._tick)

    def serve(self, script: Script) -> None:
        """Serve until the script goes down, or is over."""
        self._script = script
        self.owner.serve()

    def order(self, message: Run | Change | End | Down) -> None:
        """Give an order."""
        self.board.words[LEASE] = ME
        assert self.board.orders.put(msgspec.json.encode(Order(ME, message)))

    def run(self, behaviour: str, *, arm: bool = False, **options: Any) -> Callable[[], bool]:
        """Order a behaviour; return what is true once the client has been told of its end."""
        self._numbers += 1
        number = self._numbers
        self.order(Run(id=number, behaviour=behaviour, options=options, arm=arm))
        return lambda: any(getattr(said, "id", 0) == number for said in self.answers)

    @property
    def answers(self) -> list[Ended | Refused]:
        """What the client was told last of each behaviour."""
        return [said for said in self.told if not isinstance(said, Started)]

    @property
    def state(self) -> RunState:
        """The present state of the robot."""
        return RunState(self.board.words[STATE])

    def _tick(self, observation: Observation) -> None:
        if not self.states or self.states[-1] is not self.state:
            self.states.append(self.state)
        while (text := self.board.reports.take()) is not None:
            self.told.append(REPORTS.decode(text).message)
        if self._until():
            self._until = next(self._script, self._end)

    def _end(self) -> bool:
        self.order(Down())
        self._until = lambda: False
        return False
