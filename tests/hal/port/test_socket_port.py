"""A port behind a TCP connection that passes bytes alone."""

import os
import socket
from collections.abc import Iterator
from contextlib import ExitStack, closing

import pytest

from tests.hal.guardian.test_guardian_start import files
from windup.hal.errors import PortError, UsageError
from windup.hal.port.open_port import open_port
from windup.hal.port.port import SELECTABLE, Port
from windup.hal.port.socket_port import Connection

PATIENCE = 20.0  # s for the machine


@pytest.fixture
def server() -> Iterator[socket.socket]:
    with socket.create_server(("127.0.0.1", 0)) as made:
        made.settimeout(PATIENCE)
        yield made


def url_of(server: socket.socket) -> str:
    return f"socket://127.0.0.1:{server.getsockname()[1]}"


@pytest.fixture
def ends(server: socket.socket) -> Iterator[tuple[Port, socket.socket]]:
    with closing(open_port(url_of(server))) as port, server.accept()[0] as other:
        other.settimeout(PATIENCE)
        yield port, other


def read(port: Port, count: int) -> bytes:
    return port.read(count, port.clock.now() + PATIENCE)


def test_bytes_pass_and_a_baud_rate_does_not(ends: tuple[Port, socket.socket]) -> None:
    port, other = ends
    port.write(b"ask")
    assert other.recv(3) == b"ask"
    other.sendall(b"answer")
    assert read(port, 6) == b"answer"
    port.baud = 57_600
    assert (port.baud, port.has_baud) == (57_600, False)


def test_nothing_is_there_until_something_has_come(ends: tuple[Port, socket.socket]) -> None:
    port, other = ends
    assert port.read(1, port.clock.now()) == b""
    other.sendall(b"late")
    assert read(port, 1) == b"l"
    port.flush_input()
    assert port.read(3, port.clock.now()) == b""


def test_requests_do_not_wait_for_acknowledgements(server: socket.socket) -> None:
    with closing(Connection(url_of(server), 1_000_000)) as connection:
        assert connection._socket.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)


def test_a_connection_that_the_other_side_ends_is_a_port_that_went_away(
    ends: tuple[Port, socket.socket],
) -> None:
    port, other = ends
    other.close()
    with pytest.raises(PortError, match="was disconnected"):
        read(port, 1)


def test_descriptors_beyond_those_that_select_takes_are_read(server: socket.socket) -> None:
    with files(SELECTABLE + 100), ExitStack() as stack:
        held = [os.open(os.devnull, os.O_RDONLY)]
        while held[-1] < SELECTABLE:
            held.append(os.dup(held[0]))
        for one in held:
            stack.callback(os.close, one)
        port = stack.enter_context(closing(open_port(url_of(server))))
        other = stack.enter_context(server.accept()[0])
        port.flush_input()
        port.write(b"ask")
        assert other.recv(3) == b"ask"
        other.sendall(b"answer")
        assert read(port, 6) == b"answer"


def test_where_nobody_listens_is_told(server: socket.socket) -> None:
    url = url_of(server)
    server.close()
    with pytest.raises(PortError, match=f"{url} cannot be opened: .*Connection refused"):
        open_port(url)


@pytest.mark.parametrize("url", ["socket://", "socket://here", "socket://:5"])
def test_a_host_and_a_port_are_needed(url: str) -> None:
    with pytest.raises(UsageError, match="a host and a port are missing"):
        open_port(url)
