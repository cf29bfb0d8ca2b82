"""Stop keys, in a child whose terminal is a pseudo-terminal of ours."""

import os
import signal
import subprocess
import sys
import termios
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

ASK = "from windup.tools.stopping.stop_keys import keyboard; print(keyboard())"
ROOT = Path(__file__).parents[3]
CHILD = """
import sys, time
from windup.tools.stopping.stop_keys import keyboard, stop_keys
try:
    with stop_keys(keyboard()) as key:
        print("ready", flush=True)
        while (pressed := key()) is None:
            time.sleep(0.01)
        print(pressed, flush=True)
        if "q" in pressed:
            raise RuntimeError
except RuntimeError:
    print("raised", flush=True)
"""
TAKE_THE_TERMINAL = "import fcntl, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0)\n"


@dataclass
class Child:
    """A program with a terminal, and the person's end of that."""

    process: "subprocess.Popen[str]"
    terminal: int

    @property
    def canonical(self) -> bool:
        """Does the terminal wait for Enter?"""
        return bool(termios.tcgetattr(self.terminal)[3] & termios.ICANON)

    def line(self) -> str:
        assert self.process.stdout is not None
        return self.process.stdout.readline().strip()


@pytest.fixture
def child() -> Iterator[Child]:
    ours, theirs = os.openpty()
    process = subprocess.Popen(
        [sys.executable, "-c", TAKE_THE_TERMINAL + CHILD],
        stdin=theirs,
        stdout=subprocess.PIPE,
        text=True,
        cwd=ROOT,
        start_new_session=True,
    )
    os.close(theirs)
    yield Child(process, ours)
    process.kill()
    process.wait()
    if process.stdout is not None:
        process.stdout.close()
    os.close(ours)


@pytest.mark.parametrize(
    ("typed", "name", "after"),
    [
        (b"x ", "the space bar", ""),
        (b"Q", "the key q", "raised"),
        (b"\nq", "the key q", "raised"),
    ],
)
def test_a_stop_key_is_seen_without_enter_and_the_terminal_is_given_back(
    child: Child, typed: bytes, name: str, after: str
) -> None:
    assert child.line() == "ready" and not child.canonical
    os.write(child.terminal, typed)
    assert child.line() == name
    assert child.line() == after
    child.process.wait()
    assert child.canonical


def test_a_key_typed_ahead_of_the_run_counts(child: Child) -> None:
    os.write(child.terminal, b"q")
    assert child.line() == "ready"
    assert child.line() == "the key q"


def test_ctrl_c_still_is_a_signal(child: Child) -> None:
    assert child.line() == "ready"
    os.write(child.terminal, b"\x03")
    assert child.process.wait() == -signal.SIGINT
    assert child.canonical


def test_a_process_in_the_background_asks_no_terminal() -> None:
    ours, theirs = os.openpty()
    asking = f"import os; os.setpgid(0, 0); {ASK}"
    parent = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {asking!r}])"
    ran = subprocess.run(
        [sys.executable, "-c", TAKE_THE_TERMINAL + parent],
        stdin=theirs,
        capture_output=True,
        text=True,
        cwd=ROOT,
        start_new_session=True,
        check=True,
    )
    os.close(ours)
    os.close(theirs)
    assert ran.stdout.strip() == "None"


def test_a_pipe_is_no_keyboard() -> None:
    ran = subprocess.run(
        [sys.executable, "-c", ASK],
        stdin=subprocess.PIPE,
        capture_output=True,
        text=True,
        cwd=ROOT,
        check=True,
    )
    assert ran.stdout.strip() == "None"
