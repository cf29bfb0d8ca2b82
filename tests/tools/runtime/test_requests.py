import msgspec
import pytest

from windup.tools.remote.messages import (
    PROTOCOL,
    Ask,
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
from windup.tools.runtime.board import LEASE, Board
from windup.tools.runtime.orders import ORDERS, Order
from windup.tools.runtime.requests import Client, Requests

WELCOME = Welcome(
    robot="op3", port=None, may_arm=True, pid=1, version="0.1.0", joints=("a", "b"),
    rate_hz=125.0, deadman=0.2,
)  # fmt: skip


class Clients:
    """The requests of a runtime with two joints, and clients that remember what they are told."""

    def __init__(self) -> None:
        self.board = Board.create(2)
        self.requests = Requests(self.board, WELCOME)
        self.told: dict[int, list[ToClient]] = {}

    def join(self, protocol: int = PROTOCOL) -> Client:
        number = len(self.told) + 1
        said: list[ToClient] = []
        self.told[number] = said
        client = self.requests.clients[number] = Client(number, said.append)
        hello = Hello(protocol=protocol, version="0.1.0", client="walk", pid=10 + number)
        self.say(client, hello)
        return client

    def say(self, client: Client, *messages: FromClient) -> None:
        self.raw(client, *(msgspec.json.encode(message) for message in messages))

    def raw(self, client: Client, *lines: bytes) -> None:
        self.requests.handle(client, list(lines))

    def last(self, client: Client) -> ToClient:
        return self.told[client.number][-1]

    @property
    def orders(self) -> list[Order]:
        texts = iter(self.board.orders.take, None)
        return [ORDERS.decode(text) for text in texts]


@pytest.fixture
def clients() -> Clients:
    return Clients()


def test_a_client_is_welcomed(clients: Clients) -> None:
    assert clients.last(clients.join()) == WELCOME


def test_a_client_of_another_version_is_refused_with_the_remedy(clients: Clients) -> None:
    told = clients.last(clients.join(protocol=PROTOCOL + 1))
    assert isinstance(told, Refused) and "begin it anew with the same Windup" in told.message


def test_nothing_is_done_for_a_client_that_has_not_said_hello(clients: Clients) -> None:
    client = clients.join(protocol=99)
    clients.say(client, Take())
    assert clients.last(client) == Refused(message="the first message has to be a hello")
    clients.say(client, Goal(position=(0.0, 0.0)))
    assert clients.board.newest == 0


def test_one_client_has_the_lease_until_it_leaves(clients: Clients) -> None:
    first, second = clients.join(), clients.join()
    clients.say(first, Take())
    assert clients.last(first) == Leased() and clients.board.words[LEASE] == first.number
    clients.say(second, Run(id=5, behaviour="walk"))
    said = "walk (process 11) has op3: wait, or end that first"
    assert clients.last(second) == Refused(message=said, id=5)
    clients.requests.leave(first)
    assert clients.board.words[LEASE] == 0
    clients.say(second, Take())
    assert clients.last(second) == Leased()


def test_a_lease_that_is_given_back_is_free(clients: Clients) -> None:
    first, second = clients.join(), clients.join()
    clients.say(first, Take(), Release())
    clients.say(second, Take())
    assert clients.board.words[LEASE] == second.number


def test_orders_go_to_the_loop_with_who_gave_them(clients: Clients) -> None:
    client = clients.join()
    run = Run(id=1, behaviour="walk", options={"speed": 0.2})
    clients.say(client, run, End())
    assert clients.orders == [Order(1, run), Order(1, End())]
    assert clients.requests.status().behaviour == "walk"


def test_orders_that_the_loop_does_not_read_are_refused(clients: Clients) -> None:
    client = clients.join()
    clients.say(client, *[End()] * 9)
    told = clients.last(client)
    assert isinstance(told, Refused) and told.exit_status == 3
    assert len(clients.orders) == 8


def test_of_many_goals_at_once_the_last_good_one_counts(clients: Clients) -> None:
    client = clients.join()
    clients.say(client, Take())
    lines = [b'{"type":"goal","position":[%d,0]}' % number for number in range(5)]
    clients.raw(client, *lines, b'{"type":"goal","position":[NaN,0]}')
    assert clients.board.newest == 1
    counts = clients.board.counts()
    assert (counts["received"], counts["replaced"], counts["not_json"]) == (5, 4, 1)


@pytest.mark.parametrize(
    ("line", "count"),
    [
        (b'{"type":"goal","position":[0.0]}', "wrong_length"),
        (b'{"type":"goal","position":[NaN,0.0]}', "not_json"),
        (b'{"type":"goal","position":["a",0.0]}', "not_json"),
        (b'{"type":"goal","position":[1e999,0.0]}', "not_json"),
        (b'{"type":"leap"}', "not_json"),
        (b"\xff\xfe", "not_json"),
    ],
)
def test_a_goal_that_cannot_be_is_counted_by_name(
    clients: Clients, line: bytes, count: str
) -> None:
    client = clients.join()
    clients.say(client, Take())
    clients.raw(client, line)
    counts = {name: number for name, number in clients.board.counts().items() if number}
    assert counts.pop("received", 1) == 1
    assert counts == {count: 1}
    assert clients.board.newest == 0


def test_goals_without_the_lease_are_counted_and_refused(clients: Clients) -> None:
    client = clients.join()
    clients.say(client, Goal(position=(0.0, 0.0)))
    assert clients.last(client) == Refused(message="take the lease before you give goals")
    assert clients.board.counts()["no_lease"] == 1


def test_everybody_may_ask_how_it_is(clients: Clients) -> None:
    first, second = clients.join(), clients.join()
    clients.say(first, Take())
    clients.say(second, Ask())
    told = clients.last(second)
    assert isinstance(told, Status)
    assert (told.state, told.holder, told.clients) == ("disconnected", "walk (process 11)", 2)
