"""What the broker does with the messages of its clients; it knows nothing of sockets."""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import isfinite
from typing import Final

import msgspec

from windup.hal.publishing.run_state import RunState
from windup.tools.remote.messages import (
    PROTOCOL,
    Ask,
    Change,
    Down,
    End,
    FromClient,
    Goal,
    Hello,
    Leased,
    Refused,
    Release,
    Run,
    Status,
    Take,
    ToClient,
    Welcome,
)
from windup.tools.runtime.board import ARMED, JOINTS, LEASE, MISSED, STATE, TICKS, Board
from windup.tools.runtime.counts import Count
from windup.tools.runtime.orders import Order

DECODER: Final = msgspec.json.Decoder(FromClient)


@dataclass(eq=False)
class Client:
    """A client.

    Attributes:
        number: Its number, from 1; no two clients of a runtime have the same.
        send: Sends it a message.
        hello: Its first message; None before that.
    """

    number: int
    send: Callable[[ToClient], None]
    hello: Hello | None = None

    def __str__(self) -> str:
        if self.hello is None:
            return f"client {self.number}"
        return f"{self.hello.client} (process {self.hello.pid})"


@dataclass(eq=False)
class Requests:
    """Handles the requests of all clients.

    Attributes:
        board: The board that is shared with the loop.
        welcome: What every client is told first.
        clients: The clients by number.
        holder: The client that has the lease.
        behaviour: Behaviour that was asked for last; the loop says when it has ended.
    """

    board: Board
    welcome: Welcome
    clients: dict[int, Client] = field(default_factory=dict)
    holder: Client | None = None
    behaviour: str = ""

    def handle(self, client: Client, lines: list[bytes]) -> None:
        """Handle the lines of a client; of the goals among them only the last one counts."""
        goals = []
        for line in lines:
            try:
                message = DECODER.decode(line)
            except (msgspec.DecodeError, UnicodeDecodeError) as error:
                self._not_understood(client, str(error))
                continue
            if isinstance(message, Goal) and client.hello is not None:
                goals.append(message)
            else:
                self._answer(client, message)
        if goals:
            self._take_goals(client, goals)

    def leave(self, client: Client) -> None:
        """Forget a client that has gone; if it had the lease, the robot holds."""
        self.clients.pop(client.number, None)
        if self.holder is client:
            self._lease(None)

    def status(self, number: int | None = None) -> Status:
        """Return how the runtime is; `number` is that of the request."""
        words = self.board.words
        return Status(
            state=RunState(words[STATE]).words,
            behaviour=self.behaviour,
            armed=bool(words[ARMED]),
            ticks=words[TICKS],
            missed=words[MISSED],
            holder="" if self.holder is None else str(self.holder),
            clients=len(self.clients),
            counts=self.board.counts(),
            id=number,
        )

    def _answer(self, client: Client, message: FromClient) -> None:
        if isinstance(message, Hello):
            self._greet(client, message)
        elif client.hello is None:
            client.send(Refused(message="the first message has to be a hello"))
        elif isinstance(message, Ask):
            client.send(self.status(message.id))
        elif isinstance(message, Take):
            if self._may_have_lease(client, None):
                client.send(Leased())
        elif isinstance(message, Release):
            if self.holder is client:
                self._lease(None)
        elif isinstance(message, Run | Change | End | Down):
            self._order(client, message)

    def _greet(self, client: Client, hello: Hello) -> None:
        if hello.protocol != PROTOCOL:
            client.send(
                Refused(
                    message=f"this runtime is Windup {self.welcome.version} with messages of "
                    f"version {PROTOCOL}, and {hello.client} is Windup {hello.version} with "
                    f"version {hello.protocol}: end the runtime by `windup stop --all` and Ctrl-C, "
                    "and begin it anew with the same Windup"
                )
            )
            return
        client.hello = hello
        client.send(self.welcome)

    def _order(self, client: Client, message: Run | Change | End | Down) -> None:
        number = message.id if isinstance(message, Run) else None
        if not isinstance(message, Down) and not self._may_have_lease(client, number):
            return
        if not self.board.orders.put(msgspec.json.encode(Order(client.number, message))):
            why = "the loop has not read the last orders yet, or this one is too long"
            client.send(Refused(message=why, exit_status=3, id=number))
        elif isinstance(message, Run):
            self.behaviour = message.behaviour

    def _may_have_lease(self, client: Client, number: int | None) -> bool:
        """Give a client the lease if it is free; refuse its request if another one has it."""
        if self.holder is not None and self.holder is not client:
            said = f"{self.holder} has {self.welcome.robot}: wait, or end that first"
            client.send(Refused(message=said, id=number))
            return False
        self._lease(client)
        return True

    def _lease(self, client: Client | None) -> None:
        self.holder = client
        self.board.words[LEASE] = 0 if client is None else client.number

    def _take_goals(self, client: Client, goals: list[Goal]) -> None:
        count = self.board.count
        count(Count.RECEIVED, len(goals))
        if self.holder is not client:
            count(Count.NO_LEASE, len(goals))
            client.send(Refused(message="take the lease before you give goals"))
            return
        joints, newest = self.board.words[JOINTS], None
        for goal in goals:
            if len(goal.position) != joints:
                count(Count.WRONG_LENGTH)
            elif not all(map(isfinite, goal.position)):
                count(Count.NOT_FINITE)
            else:
                if newest is not None:
                    count(Count.REPLACED)
                newest = goal.position
        if newest is not None:
            self.board.put_goal(newest)

    def _not_understood(self, client: Client, why: str) -> None:
        self.board.count(Count.NOT_JSON)
        client.send(Refused(message=f"this is no message of the protocol: {why}"))
