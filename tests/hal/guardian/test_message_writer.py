"""What a guardian says, where nobody may be reading."""

import os
from collections.abc import Iterator

import pytest

from tests.hal.guardian.two_servos import full_pipe
from windup.hal.guardian.message_writer import LINES, MessageWriter

LONG_ENOUGH = 10.0


@pytest.fixture
def pipe() -> Iterator[tuple[int, int]]:
    reading, writing = os.pipe()
    yield reading, writing
    os.close(writing)


def test_what_is_said_is_written_in_order(pipe: tuple[int, int]) -> None:
    writer = MessageWriter(pipe[1])
    writer.write_line("one")
    writer.write_line("two")
    writer.finish(LONG_ENOUGH)
    assert os.read(pipe[0], 100) == b"windup guardian: one\nwindup guardian: two\n"
    os.close(pipe[0])


def test_who_does_not_read_keeps_nobody_waiting() -> None:
    with full_pipe() as writing:
        writer = MessageWriter(writing)
        for _ in range(10 * LINES):
            writer.write_line("torque is not known to be off")
        writer.finish(0.0)
        assert writer._thread.is_alive() and writer._lines.full()


def test_of_too_many_lines_the_last_are_kept(pipe: tuple[int, int]) -> None:
    writer = MessageWriter(None)
    for number in range(2 * LINES):
        writer.write_line(str(number))
    assert writer._lines.qsize() == LINES
    assert writer._lines.get() == f"windup guardian: {LINES}\n".encode()


def test_a_reader_that_has_gone_is_no_error(pipe: tuple[int, int]) -> None:
    os.close(pipe[0])
    writer = MessageWriter(pipe[1])
    writer.write_line("one")
    writer.write_line("two")
    writer.finish(LONG_ENOUGH)
    assert not writer._thread.is_alive()


def test_where_standard_error_is_closed_nothing_is_said() -> None:
    writer = MessageWriter(None)
    writer.write_line("one")
    writer.finish(LONG_ENOUGH)
    assert not writer._thread.is_alive()
