import io
import subprocess
import sys
from typing import IO, cast

import pytest
from rich.console import Console

from windup.tools.terminal.streams import StandardError, drop_unwritten


class Full(io.StringIO):
    def write(self, text: str) -> int:
        raise OSError(28, "No space left on device")


def test_words_for_people_never_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    console = Console(file=cast(IO[str], StandardError()))
    for stream in (Full(), None):
        monkeypatch.setattr(sys, "stderr", stream)
        console.print("step 3")
    heard = io.StringIO()
    monkeypatch.setattr(sys, "stderr", heard)
    console.print("step 4")
    assert heard.getvalue() == "step 4\n"


def test_what_a_full_device_did_not_take_is_dropped() -> None:
    with open("/dev/full", "w") as full:  # its `close` would fail as well
        full.write("figures")
        drop_unwritten(full)
        full.write("more")
    drop_unwritten(None)


def test_no_file_gets_the_number_of_a_closed_standard_stream() -> None:
    program = "from windup.tools.terminal.streams import fill_closed_streams as f; f(); " + (
        "import os; raise SystemExit(os.open('/dev/zero', os.O_RDWR))"
    )
    run = subprocess.run(
        ["sh", "-c", '"$0" -c "$1" <&- >&- 2>&-', sys.executable, program], timeout=60, check=False
    )
    assert run.returncode > 2
