"""A broker in a process of its own, between real clients and a loop that the tests play."""

import os
import socket
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import msgspec
import pytest

from windup.hal.errors import HardwareError, UsageError
from windup.hal.publishing.run_state import RunState
from windup.tools.remote.client import RuntimeClient
from windup.tools.remote.messages import Ended, Run, Started, Status, ToClient, Welcome
from windup.tools.remote.place import Place
from windup.tools.runtime.board import LEASE, STATE, Board
from windup.tools.runtime.broker import UNREAD
from windup.tools.runtime.orders import ORDERS, Order, Report
from windup.tools.runtime.start_broker import BrokerProcess

WELCOME = Welcome(
    robot="op3", port=None, may_arm=True, pid=os.getpid(), version="0.1.0", joints=("a", "b"),
    rate_hz=125.0, deadman=0.2,
)  # fmt: skip


class Loop:
    """The loop's side of a runtime."""

    def __init__(self, folder: Path) -> None:
        self.place = Place.of("op3", folder)
        self.board = Board.create(2)
        self.broker = BrokerProcess(self.place, self.board, WELCOME)

    def client(self) -> RuntimeClient:
        return RuntimeClient("op3", "test", self.place)

    def order(self) -> Order:
        while (text := self.board.orders.take()) is None:
            os.sched_yield()
        return ORDERS.decode(text)

    def report(self, client: int, message: Started | Ended) -> None:
        assert self.board.reports.put(msgspec.json.encode(Report(client, message)))
        self.broker.ring()

    def wait_until(self, true: Callable[[], bool]) -> None:
        while not true():
            os.sched_yield()


@pytest.fixture(scope="module")
def loop() -> Iterator[Loop]:
    with tempfile.TemporaryDirectory() as folder:  # short: a socket's path has to be
        playing = Loop(Path(folder))
        yield playing
        playing.broker.end()
        playing.board.close()


def test_only_its_user_may_enter_the_socket(loop: Loop) -> None:
    assert loop.place.socket.stat().st_mode & 0o777 == 0o600


def test_a_client_is_welcomed_and_sees_the_state_change(loop: Loop) -> None:
    with loop.client() as client:
        assert client.welcome == WELCOME
        assert client.status().state == "disconnected"
        loop.board.words[STATE] = RunState.HOLDING
        loop.broker.ring()
        told = client.receive(10.0)
        assert isinstance(told, Status) and told.state == "holding"


def test_a_behaviour_is_ordered_started_and_ended(loop: Loop) -> None:
    with loop.client() as client:
        client.send(Run(id=1, behaviour="walk", options={"speed": 0.2}))
        order = loop.order()
        assert order.message == Run(id=1, behaviour="walk", options={"speed": 0.2})
        assert loop.board.words[LEASE] == order.client
        loop.report(order.client, Started(id=1))
        loop.report(order.client, Ended(id=1, good=True, reason="done", lines=("walked",)))
        told: list[ToClient | None] = [client.receive(10.0), client.receive(10.0)]
        assert told[0] == Started(id=1)
        assert isinstance(told[1], Ended) and told[1].lines == ("walked",)


def test_a_client_that_dies_gives_its_lease_back(loop: Loop) -> None:
    client = loop.client()
    client.take()
    assert loop.board.words[LEASE] > 0
    client.close()
    loop.wait_until(lambda: loop.board.words[LEASE] == 0)


def test_a_second_client_is_refused_with_who_has_the_robot(loop: Loop) -> None:
    with loop.client() as first, loop.client() as second:
        first.take()
        with pytest.raises(UsageError, match=rf"test \(process {os.getpid()}\) has op3"):
            second.take()
    loop.wait_until(lambda: loop.board.words[LEASE] == 0)


def test_a_client_that_reads_nothing_is_dropped(loop: Loop) -> None:
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as link, loop.client() as other:
        link.connect(str(loop.place.socket))
        line = b"x" * 1000 + b"\n"
        with pytest.raises(OSError):
            for _ in range(100 * UNREAD // len(line)):
                link.sendall(line)
        assert other.status().clients == 1


def test_a_line_without_an_end_is_not_kept(loop: Loop) -> None:
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as link:
        link.connect(str(loop.place.socket))
        with pytest.raises(OSError):
            for _ in range(1000):
                link.sendall(bytes(1 << 16))


def test_a_robot_that_is_not_up_is_refused(loop: Loop) -> None:
    place = Place.of("duck", loop.place.lock.parent)
    with pytest.raises(UsageError, match="duck is not up; begin it with `windup up duck`"):
        RuntimeClient("duck", "test", place)


def test_a_runtime_that_ends_is_told_to_who_waits() -> None:
    with tempfile.TemporaryDirectory() as folder:
        loop = Loop(Path(folder))
        with loop.client() as client:
            loop.broker.end()
            with pytest.raises(HardwareError, match="the runtime of op3 has ended"):
                client.receive(10.0)
        with pytest.raises(UsageError, match="op3 is not up: its runtime has died"):
            loop.client()
        loop.board.close()
