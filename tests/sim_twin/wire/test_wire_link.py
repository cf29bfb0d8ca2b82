"""Who may plug into a TCP port of an emulator."""

import socket
import struct
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing, suppress
from select import select
from urllib.parse import urlsplit

import pytest

from sim_twin.wire.link import Tcp

PATIENCE = 20.0  # s for the machine
CLIENT = """
import socket, sys
s = socket.create_connection(("127.0.0.1", int(sys.argv[1])))
print("there", flush=True)
sys.stdin.read()
"""


@pytest.fixture
def tcp() -> Iterator[Tcp]:
    with closing(Tcp(0)) as link:
        yield link


def port_of(tcp: Tcp) -> int:
    port = urlsplit(tcp.name).port
    assert port is not None
    return port


def connect(tcp: Tcp) -> socket.socket:
    client = socket.create_connection(("127.0.0.1", port_of(tcp)), PATIENCE)
    receive(tcp)
    return client


def receive(tcp: Tcp) -> bytes:
    """Wait until something comes, and take it."""
    assert select(tcp.descriptors(), [], [], PATIENCE)[0]
    return tcp.receive()


def closed(client: socket.socket) -> bool:
    """Whether the other end has closed the connection."""
    with suppress(ConnectionResetError):
        return client.recv(1) == b""
    return True


def test_a_second_program_is_refused_while_the_first_is_there(tcp: Tcp) -> None:
    with connect(tcp) as first, connect(tcp) as second:
        assert closed(second)
        first.sendall(b"ask")
        assert receive(tcp) == b"ask"
        tcp.send(b"answer")
        assert first.recv(6) == b"answer"


def test_a_program_that_has_closed_its_connection_makes_room(tcp: Tcp) -> None:
    connect(tcp).close()
    with connect(tcp) as second:
        second.sendall(b"ask")
        assert receive(tcp) == b"ask"


def test_what_the_first_program_sent_before_it_left_is_taken_in(tcp: Tcp) -> None:
    with connect(tcp) as first:
        first.sendall(b"torque off")
    with socket.create_connection(("127.0.0.1", port_of(tcp)), PATIENCE) as second:
        assert receive(tcp) == b"torque off"
        second.sendall(b"ask")
        assert receive(tcp) == b"ask"


def test_a_connection_that_was_reset_makes_room(tcp: Tcp) -> None:
    first = connect(tcp)
    first.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    first.close()
    with connect(tcp) as second:
        second.sendall(b"ask")
        assert receive(tcp) == b"ask"


def test_a_program_that_was_killed_makes_room(tcp: Tcp) -> None:
    arguments = [sys.executable, "-c", CLIENT, str(port_of(tcp))]
    with subprocess.Popen(arguments, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        receive(tcp)
        assert process.stdout is not None and process.stdout.readline() == b"there\n"
        with connect(tcp) as second:
            assert closed(second)
        process.kill()
    with connect(tcp) as third:
        third.sendall(b"ask")
        assert receive(tcp) == b"ask"
