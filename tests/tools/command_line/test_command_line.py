import subprocess
import sys

import pytest

from tests.tools.conftest import Windup, refusal
from windup.tools.command_line.table import COMMANDS, Entry
from windup.tools.command_line.version import installed_version
from windup.tools.terminal.command import Command

LINES = {
    "misspelt": ("walk op3 --hlep", "walk: unknown option --hlep (did you mean --help?)"),
    "alone": ("walk --hlep", "walk: unknown option --hlep (did you mean --help?)"),
    "option": ("walk op3 --stepps 3", "(did you mean --steps?); `windup walk --help` lists all"),
    "value": ("walk op3 --stepps=3", "unknown option --stepps (did you mean --steps?)"),
    "no near one": ("walk op3 --xyzzy", "unknown option --xyzzy; `windup walk --help` lists all"),
    "switch": ("push op3 --impulse 1 --no-cach", "(did you mean --no-catch?)"),
    "command": ("wlak op3", "unknown command 'wlak' (did you mean walk?); `windup --help` lists"),
    "other": ("dance", "unknown command 'dance'; `windup --help` lists all"),
    "nothing": ("", "give a command, such as `windup robots`; `windup --help` lists all"),
    "positional": ("walk", "walk: give ROBOT (a robot's name"),
    "needed": ("synthesise op3", "synthesise: give --out PATH (gait file to write"),
    "noisy robot": (
        "stand op3 --port /dev/ttyUSB9 --arm --noise 1",
        "--noise is of a twin's start",
    ),
    "help": ("help", "unknown command 'help' (did you mean --help?)"),
    "armed twin": ("stand op3 --arm", "--arm needs a --port; without one only the twin moves"),
    "choice": ("walk op3 --sampling best", "see `windup walk --help`"),
    "swept": ("sweep walk op3 --hlep --out a.csv", "unknown option --hlep (did you mean --help?)"),
    "bench": (
        "bench",
        "bench: give one of tick, twin, balance, servo, bus, safety, guardian, loop, slow, faults, "
        "unplug, leaks, starts, fuzz, startup (what to measure); see `windup bench --help`",
    ),
    "new": ("new", "new: give one of robot, gait, controller (what to write); see `windup new"),
    "plot": ("stand op3 --plot a.png", "stand: unknown option --plot"),
}


@pytest.mark.usefixtures("nothing_opens")
@pytest.mark.parametrize(("line", "said"), LINES.values(), ids=LINES)
def test_a_wrong_word_is_one_line_with_the_near_one(line: str, said: str) -> None:
    assert said in refusal(line.split())


@pytest.mark.parametrize("word", ["-h", "--help"])
def test_the_help_fits_one_screen(shell: Windup, word: str) -> None:
    ran = shell(word)
    lines = ran.out.splitlines()
    assert (ran.status, ran.err) == (0, "")
    assert len(lines) < 30
    assert max(map(len, lines)) < 80
    assert all(any(line.startswith(f"{name} ") for line in lines) for name in COMMANDS)


@pytest.mark.parametrize("line", [["--help"], ["walk", "--help"]])
def test_help_that_nobody_can_read_is_told(
    shell: Windup, monkeypatch: pytest.MonkeyPatch, line: list[str]
) -> None:
    monkeypatch.setattr("sys.stdout", None)
    ran = shell(*line)
    assert (ran.status, ran.err) == (2, "windup: standard output cannot be written: it is closed\n")


def test_every_command_says_in_a_few_words_what_it_does() -> None:
    assert all(len(entry.gist) >= len("Push a robot") for entry in COMMANDS.values())


@pytest.mark.parametrize("entry", COMMANDS.values(), ids=COMMANDS)
def test_the_table_of_commands_knows_where_each_is(entry: Entry) -> None:
    assert issubclass(entry.load(), Command)


def test_the_overview_imports_no_command() -> None:
    code = (
        "import sys\nfrom windup.tools.cli import run\nstatus = run(['--help'])\n"
        "print(sorted({'mujoco', 'tyro', 'scipy'} & set(sys.modules)), status)"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ran.stdout.splitlines()[-1] == "[] 0"


def test_the_version_is_told(shell: Windup) -> None:
    assert shell("--version").out == f"windup {installed_version()}\n"


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_its_own_help(shell: Windup, name: str) -> None:
    ran = shell(name, "--help")
    assert (ran.status, ran.err) == (0, "")
    assert f"usage: windup {name} " in ran.out
