"""Who may plug into a TCP port of an emulator, and where a pseudo-terminal may be put."""

import os
import socket
import struct
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, closing, suppress
from pathlib import Path
from select import select
from urllib.parse import urlsplit

import pytest

from windup.hal.errors import UsageError
from windup.sim_twin.wire.serve.emulate import _readable
from windup.sim_twin.wire.serve.link import Pty, Tcp

PATIENCE = 20.0  # s for the machine
MOST = 65_536
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
    return tcp.receive(MOST)


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


def test_hundreds_of_programs_are_refused_and_the_first_one_is_served(tcp: Tcp) -> None:
    with connect(tcp) as first, ExitStack() as stack:
        for _ in range(10):
            others = [
                stack.enter_context(socket.create_connection(("127.0.0.1", port_of(tcp)), PATIENCE))
                for _ in range(40)
            ]
            receive(tcp)
            assert all(closed(other) for other in others)
        first.sendall(b"ask")
        assert receive(tcp) == b"ask"


def test_a_pseudo_terminal_gives_all_that_was_written_and_takes_its_link_away(
    tmp_path: Path,
) -> None:
    path = tmp_path / "bus"
    with closing(Pty(path)) as link, path.open("wb", buffering=0) as program:
        assert link.name == str(path)
        program.write(b"ask" * 1000)
        got = b""
        while len(got) < 3000:
            assert select(link.descriptors(), [], [], PATIENCE)[0]
            got += link.receive(MOST)
        assert got == b"ask" * 1000
    assert not path.is_symlink()


def test_the_link_of_a_dead_emulator_is_replaced(tmp_path: Path) -> None:
    path = tmp_path / "bus"
    path.symlink_to("/dev/pts/987654")
    with closing(Pty(path)):
        assert path.exists()


@pytest.mark.parametrize("target", ["/dev/null", "/dev/ttyUSB987654", "other"])
def test_a_link_that_is_not_ours_stays(tmp_path: Path, target: str) -> None:
    path = tmp_path / "bus"
    path.symlink_to(target)
    with pytest.raises(UsageError, match=f"is a link to {target}, not to an emulated port"):
        Pty(path)
    assert path.readlink() == Path(target)


def test_the_link_of_a_living_emulator_stays(tmp_path: Path) -> None:
    path = tmp_path / "bus"
    with closing(Pty(path)):
        target = path.readlink()
        with pytest.raises(UsageError, match="which is in use, perhaps by an emulator"):
            Pty(path)
        assert path.readlink() == target


def test_a_link_that_somebody_has_changed_stays_behind(tmp_path: Path) -> None:
    path = tmp_path / "bus"
    link = Pty(path)
    path.unlink()
    path.symlink_to("/dev/null")
    link.close()
    assert path.readlink() == Path("/dev/null")


def test_a_file_and_a_folder_that_is_not_there_are_told(tmp_path: Path) -> None:
    (tmp_path / "bus").write_text("mine")
    with pytest.raises(UsageError, match="exists and is not the link of an emulated port"):
        Pty(tmp_path / "bus")
    with pytest.raises(UsageError, match=r"cannot make .*: No such file or directory"):
        Pty(tmp_path / "nowhere" / "bus")


def test_descriptors_beyond_those_that_select_takes_are_waited_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("windup.sim_twin.wire.serve.emulate.SELECTABLE", 0)
    reader, writer = os.pipe()
    try:
        assert _readable([reader], 0.0) == []
        os.write(writer, b"x")
        assert _readable([reader], PATIENCE) == [reader]
    finally:
        os.close(reader)
        os.close(writer)
