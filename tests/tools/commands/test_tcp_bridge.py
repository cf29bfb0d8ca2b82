"""A robot behind a TCP bridge, such as ser2net: bytes pass, baud rates do not. Nothing is timed."""

import os
import select
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import serial

from tests.tools.commands.test_emulate import said, start

CLI = [sys.executable, "-c", "from windup.tools.cli import main; main()"]


@contextmanager
def bridge(path: Path, baud: int) -> Iterator[str]:
    """Pass bytes between one TCP client and a serial port; yield what the client opens."""
    end, ended = os.pipe()
    with (
        serial.Serial(str(path), baud, timeout=0.0) as port,
        socket.create_server(("127.0.0.1", 0)) as server,
    ):
        thread = threading.Thread(target=_pass, args=(port, server, end))
        thread.start()
        try:
            yield f"socket://127.0.0.1:{server.getsockname()[1]}"
        finally:
            os.write(ended, b"x")
            thread.join()
            os.close(end)
            os.close(ended)


def _pass(port: serial.Serial, server: socket.socket, end: int) -> None:
    """Serve one client after the other until told to end."""
    client: socket.socket | None = None
    while True:
        places = [end, port.fileno(), server, *([client] if client else [])]
        ready = select.select(places, [], [])[0]
        if end in ready:
            break
        if server in ready:
            client = server.accept()[0]
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if port.fileno() in ready and (data := port.read(4096)) and client:
            client.sendall(data)
        if client and client in ready:
            data = client.recv(4096)
            port.write(data)
            if not data:
                client.close()
                client = None
    if client:
        client.close()


def test_op3_stands_behind_a_bridge(tmp_path: Path) -> None:
    path = tmp_path / "bus"
    with start("twin://op3?physics=inertia", "--pty", str(path)) as emulator:
        said(emulator)
        with bridge(path, 2_000_000) as url:
            stood = subprocess.run(
                [*CLI, "stand", "op3", "--port", url, "--arm", "--seconds", "0.5"],
                capture_output=True,
                text=True,
                check=False,
            )
        emulator.terminate()
        assert emulator.wait(20) == 0
    assert stood.returncode == 0, stood.stderr
    assert "torque is off at all 20 joints, read back" in stood.stderr
