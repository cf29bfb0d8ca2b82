import os
import subprocess
from collections.abc import Iterator

import pytest

from windup.hal.guardian.host import Host
from windup.hal.guardian.order import FIRST, HAND_OVER, IDLE, MAX_SILENCE, RELEASE, TICK
from windup.hal.guardian.process import StopReason, watch

Pipe = tuple[int, int]


@pytest.fixture
def program() -> "Iterator[subprocess.Popen[bytes]]":
    with subprocess.Popen(["sleep", "60"]) as process:
        yield process
        process.kill()


@pytest.fixture
def pipe() -> Iterator[Pipe]:
    reading, writing = os.pipe()
    yield reading, writing
    os.close(reading)


@pytest.mark.parametrize(
    ("said", "ending"),
    [
        (RELEASE, StopReason.RELEASED),
        (HAND_OVER, StopReason.HANDED_OVER),
        (TICK + RELEASE, StopReason.RELEASED),
        (TICK, StopReason.SILENT),
        (IDLE, StopReason.SILENT),
    ],
)
def test_what_is_heard_last_says_how_it_ends(
    program: "subprocess.Popen[bytes]", pipe: Pipe, said: bytes, ending: StopReason
) -> None:
    os.write(pipe[1], said)
    assert watch(pipe[0], Host(program.pid))[0] is ending
    os.close(pipe[1])


@pytest.mark.parametrize(
    ("said", "moved"),
    [
        (IDLE, False),
        (FIRST, False),
        (FIRST + TICK, True),
        (TICK + IDLE, True),
        (TICK + FIRST, False),
    ],
)
def test_a_robot_that_has_not_made_its_first_motion_does_not_crouch(
    program: "subprocess.Popen[bytes]", pipe: Pipe, said: bytes, moved: bool
) -> None:
    os.write(pipe[1], said + IDLE)
    assert watch(pipe[0], Host(program.pid)) == (StopReason.SILENT, moved)
    os.close(pipe[1])


def test_a_host_that_dies_is_seen_though_its_pipe_is_open(
    program: "subprocess.Popen[bytes]", pipe: Pipe
) -> None:
    host = Host(program.pid)
    program.kill()
    assert watch(pipe[0], host)[0] is StopReason.DIED
    os.close(pipe[1])


def test_a_pipe_that_closes_while_the_host_lives_is_no_release(
    program: "subprocess.Popen[bytes]", pipe: Pipe
) -> None:
    os.write(pipe[1], TICK)
    os.close(pipe[1])
    assert watch(pipe[0], Host(program.pid))[0] is StopReason.CLOSED


def test_a_robot_that_moves_is_given_less_time_than_one_that_is_held() -> None:
    assert MAX_SILENCE[TICK] == 0.15 < MAX_SILENCE[IDLE]
