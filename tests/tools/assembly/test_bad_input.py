import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.tools.conftest import Ran, Windup
from windup import Robot
from windup.hal.errors import UsageError
from windup.sim_twin.twin import Twin
from windup.tools.assembly.walk_options import WalkOptions

GAIT = """
title = "Bow"
loop = false
[[state]]
name = "down"
pose = { l_knee = 20 }
until = { time = 0.1 }
[[state]]
name = "up"
until = { time = 0.1 }
"""


@pytest.fixture
def still(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let no physics step pass: bad input moves nothing."""

    def moved(self: Twin, steps: int) -> None:
        raise AssertionError("the twin moved")

    monkeypatch.setattr(Twin, "step", moved)


def refused(ran: Ran, command: str, message: str) -> None:
    """Check that bad input became one line, one JSON object, and status 2."""
    assert ran.status == 2
    lines = ran.err.strip().splitlines()
    assert len(lines) == 1, ran.err
    assert lines[0].startswith("windup: ")
    assert message in lines[0]
    error: dict[str, Any] = ran.json
    assert set(error) == {"schema", "command", "error"}
    assert error["command"] == command
    assert set(error["error"]) == {"kind", "message", "exit_status"}
    assert error["error"]["exit_status"] == 2
    assert lines[0] == f"windup: {error['error']['message']}"


OPTIONS = {
    "robot": ("walk opp3", "unknown robot 'opp3'; did you mean 'op3'? known: "),
    "robot of play": ("play opp3 wave", "unknown robot 'opp3'; did you mean 'op3'? known: "),
    "robot of bench": ("bench tick --robot opp3", "unknown robot 'opp3'; did you mean 'op3'?"),
    "gait": ("walk op3 --gait wlak", "unknown gait of op3 'wlak'; did you mean 'walk'? known: "),
    "graph": ("play op3 wvae", "unknown gait of op3 'wvae'; did you mean 'wave'? known: "),
    "gait file": ("walk op3 --gait nothere.toml", "no file nothere.toml; the gaits of op3 are "),
    "bus": ("stand op3 --port legs=twin://op3", "op3 has no bus 'legs'; give --port "),
    "option of another bench": (
        "bench loop --vendor feetech",
        "bench loop takes no --vendor; these do: bus",
    ),
    "regulation variable": (
        "walk op3 --rv upp",
        "unknown regulation variable 'upp'; did you mean 'up'? known: com_displacement, ",
    ),
    "as many variables": (
        "walk op3 --rv up xcom swing_com stance_com",
        "perturbations for 8 regulation variables",
    ),
    "no steps": ("walk op3 --steps 0", "--steps 0: give 1 .. 1000000"),
    "negative steps": ("walk op3 --steps -3", "--steps -3: give 1 .. 1000000"),
    "rate": (
        "walk op3 --rate 300",
        "a rate of 300 Hz is not a whole number of physics steps of 2 ms; 250 Hz is",
    ),
    "rate too high": ("walk op3 --rate 1000", "a rate of 1000 Hz is not a whole number of physics"),
    "no rate": ("walk op3 --rate 0", "--rate 0: give 1 .. 10000 Hz"),
    "rate that is no number": ("walk op3 --rate nan", "--rate nan: give a finite number of Hz"),
    "no seeds": ("walk op3 --seeds 0", "--seeds 0: give 1 .. 100000"),
    "negative seed": ("walk op3 --seed -1 --noise 0.2", "--seed -1"),
    "speed": ("walk op3 --speed 9", "speed 9 m/s is outside the range of gait 'walk': 0 .. "),
    "speed of a gait without": ("walk human12 --speed 1", "gait 'walk' has no speed table; "),
    "target unknown": ("walk op3 --target upp=1", "unknown --target 'upp'; "),
    "target no number": ("walk op3 --target up=much", "--target up=much: 'much' is no number"),
    "target nan": ("walk op3 --target up=nan", "--target up=nan"),
    "delay in mid-step": (
        "walk op3 --delay 0.003",
        "--delay 0.003: give a whole number of physics steps of 0.002 s",
    ),
    "negative delay": ("walk op3 --delay -0.002", "--delay -0.002: give 0 .. 1 s"),
    "delay nan": ("walk op3 --delay nan", "--delay nan"),
    "delay inf": ("walk op3 --delay inf", "--delay inf"),
    "negative noise": ("walk op3 --noise -1", "--noise -1"),
    "noise nan": ("walk op3 --noise nan", "--noise nan"),
    "no seconds": ("play op3 wave --seconds 0", "--seconds 0: give more than 0"),
    "seconds nan": ("play op3 squat --seconds nan", "--seconds nan"),
    "a graph without steps": (
        "walk op3 --gait wave",
        "gait 'wave' has no steps to balance; play it with `windup play op3 wave`",
    ),
    "several seeds": ("walk op3 --seeds 2 --speed 9", "speed 9 m/s is outside the range"),
}


@pytest.mark.usefixtures("still")
@pytest.mark.parametrize(("line", "message"), OPTIONS.values(), ids=OPTIONS.keys())
def test_bad_options_are_one_line_and_nothing_moves(shell: Windup, line: str, message: str) -> None:
    command = line.split()[0]
    refused(shell(*line.split(), "--json", "-"), command, message)


@pytest.mark.parametrize(
    "line",
    ["walk op3 --steps many", "walk op3 --sampling best", "walk", "walk op3 --stepps 3", "dance"],
)
def test_what_the_command_line_cannot_mean_is_status_2_and_no_output(
    shell: Windup, line: str
) -> None:
    ran = shell(*line.split())
    assert (ran.status, ran.out) == (2, "")
    assert "Traceback" not in ran.err


def test_what_the_command_line_cannot_mean_is_json_where_json_was_asked_for(
    shell: Windup,
) -> None:
    ran = shell("walk", "op3", "--steps", "many", "--json", "-")
    assert ran.status == 2
    assert ran.json["error"]["exit_status"] == 2


@pytest.mark.usefixtures("still")
@pytest.mark.parametrize("option", ["--json", "--plot"])
def test_a_result_that_cannot_be_written_is_found_out_first(
    shell: Windup, tmp_path: Path, option: str
) -> None:
    ran = shell("walk", "op3", option, tmp_path / "none" / "result.png")
    assert ran.status == 2
    assert "cannot be written: there is no folder" in ran.err


@pytest.mark.usefixtures("still")
def test_calls_with_bad_numbers_are_refused_before_anything_moves() -> None:
    bad = float("nan")
    with Robot.open("op3") as robot:
        for call, said in (
            (lambda: robot.walk(speed=bad), "speed nan: give a finite number of m/s"),
            (lambda: robot.walk(options=WalkOptions(turn=bad)), "turn nan: give a finite number"),
            (lambda: robot.walk(steps=0), "steps 0: give 1 .. 1000000"),
            (lambda: robot.stand(bad), "seconds nan: give a finite number of s"),
            (lambda: robot.play("wave", -1.0), "seconds -1: give 0 .. 10000000 s"),
            (lambda: robot.push(float("inf")), "impulse inf: give a finite number"),
        ):
            with pytest.raises(UsageError, match=said):
                call()


ROBOT = {
    "broken TOML": ("[fall]", "[fall", "not TOML: "),
    "unknown key": ("rate_hz", "rat_hz", "unknown key 'rat_hz'; did you mean 'rate_hz'?"),
    "wrong type": ("rate_hz = 250.0", 'rate_hz = "fast"', "rate_hz: Expected `float`, got `str`"),
    "rate that does not divide": (
        "rate_hz = 250.0",
        "rate_hz = 300.0",
        "rate_hz: a period of 1/300 s is not a whole number of physics steps",
    ),
    "unknown joint": ('"l_knee"', '"l_kne"', "unknown MJCF hinge 'l_kne'; did you mean 'l_knee'?"),
}


@pytest.mark.usefixtures("still")
@pytest.mark.parametrize(("old", "new", "message"), ROBOT.values(), ids=ROBOT.keys())
def test_a_broken_robot_folder_is_one_line_with_file_and_key(
    shell: Windup, my_op3: Path, old: str, new: str, message: str
) -> None:
    path = my_op3 / "robot.toml"
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    ran = shell("walk", my_op3, "--json", "-")
    refused(ran, "walk", message)
    assert f"windup: {path}: " in ran.err


GRAPH = {
    "broken TOML": ("[[state]]", "[[state]", "not TOML: "),
    "unknown key": ("loop", "lop", "unknown key 'lop'; did you mean 'loop'?"),
    "unknown joint": (
        "l_knee",
        "l_kne",
        "state.down.pose: unknown joint 'l_kne'; did you mean 'l_knee'?",
    ),
    "pose outside the limits": (
        "l_knee = 20",
        "l_knee = 200",
        "state.down.pose.l_knee: 200 degrees is outside the joint's limits -18.0 .. 126.0",
    ),
    "unreachable state": ("0.1 }\n[[", '0.1 }\nnext = "down"\n[[', "no state leads to up; "),
    "unknown contact": (
        "until = { time = 0.1 }\n[[",
        'until = { contact = "left_fot" }\n[[',
        "state.down.until.contact: unknown contact 'left_fot'; did you mean 'left_foot'?",
    ),
    "unknown next": (
        "0.1 }\n[[",
        '0.1 }\nnext = "upp"\n[[',
        "state.down.next: unknown state 'upp'; did you mean 'up'?",
    ),
}


@pytest.mark.usefixtures("still")
@pytest.mark.parametrize(("old", "new", "message"), GRAPH.values(), ids=GRAPH.keys())
def test_a_broken_gait_is_one_line_with_file_and_key(
    shell: Windup, my_op3: Path, old: str, new: str, message: str
) -> None:
    path = my_op3 / "gaits" / "bow.toml"
    assert old in GAIT
    path.write_text(GAIT.replace(old, new, 1))
    ran = shell("play", my_op3, "bow", "--json", "-")
    refused(ran, "play", message)
    assert f"windup: {path}: " in ran.err


def test_a_sound_folder_of_ones_own_is_played(shell: Windup, my_op3: Path) -> None:
    (my_op3 / "gaits" / "bow.toml").write_text(GAIT)
    ran = shell("play", my_op3, "bow", "--json", "-")
    assert ran.status == 0
    assert ran.json["reason"] == "done"


def test_a_reader_that_goes_away_leaves_no_traceback() -> None:
    command = [sys.executable, "-c", "from windup.tools.cli import main; main()", "push", "--help"]
    run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert run.stdout is not None
    run.stdout.close()
    _, said = run.communicate(timeout=60)
    assert (run.returncode, said) == (1, "")
