"""`windup run` with controllers in files of one's own."""

from pathlib import Path

import pytest

from tests.tools.conftest import Windup, refusal

HEAD = """\
import math

from windup import JointCommand


class Sine:
    \"\"\"Moves the shoulders.

    Args:
        gain: How far they swing, degrees.
    \"\"\"

    def __init__(self, joints, stance, gain: float = 10.0):
        self.joints, self.stance, self.gain = joints, stance, gain
        self.way = joints.array({"l_sho_pitch": 1.0, "r_sho_pitch": 1.0})

    def reset(self, observation):
        self.begin = observation.time

"""
STEP = """\
    def step(self, observation, dt):
        angle = math.radians(self.gain) * math.sin(6.0 * (observation.time - self.begin))
        return JointCommand.of(self.joints, position=self.stance + angle * self.way)
"""
SINE = HEAD + STEP


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def sine(here: Path) -> Path:
    (here / "sine.py").write_text(SINE)
    return here / "sine.py"


@pytest.mark.usefixtures("sine")
@pytest.mark.parametrize("port", [(), ("--port", "twin://op3?clock=virtual")], ids=["twin", "wire"])
def test_a_class_with_reset_and_step_runs(shell: Windup, port: tuple[str, ...]) -> None:
    ran = shell("run", "op3", "sine.py", "--gain", "20", "--seconds", "1", *port, "--json", "-")
    assert ran.status == 0, ran.err
    assert ran.json["command"] == "run"
    assert ran.json["behaviour"] == "Sine"
    assert ran.json["options"] == {"seconds": 1.0, "gain": 20.0}
    assert (ran.json["reason"], ran.json["fell"]) == ("done", False)
    assert "op3 ran Sine for 1.0" in ran.err


@pytest.mark.usefixtures("sine")
def test_arguments_of_the_constructor_are_in_the_help(shell: Windup) -> None:
    text = " ".join(shell("run", "op3", "sine.py:Sine", "--help").out.split())
    assert text.startswith("usage: windup run [-h] [OPTIONS] ROBOT FILE Moves the shoulders.")
    assert "--gain FLOAT" in text and "How far they swing, degrees." in text
    assert "--seconds" in text and "--push-at" in text
    assert "--joints" not in text


@pytest.mark.usefixtures("sine")
def test_a_misspelt_option_of_it_is_told() -> None:
    line = refusal(["run", "op3", "sine.py", "--gian", "3"])
    assert "unknown option --gian (did you mean --gain?)" in line
    assert "`windup run op3 sine.py --help` lists all" in line


WRONG = {
    "no file": (None, "x.py", "x.py cannot be read: No such file or directory"),
    "syntax": ("a = 1\nb = (\n", "x.py", "x.py:2: SyntaxError: '(' was never closed"),
    "import": ("\nimport nowhere\n", "x.py", "x.py:2: ModuleNotFoundError: No module named"),
    "exit": ("raise SystemExit(3)\n", "x.py", "ends the program when it is loaded"),
    "none": ("a = 1\n", "x.py", "x.py has no controller: a class with reset(observation)"),
    "no such name": (SINE, "x.py:Sin", "x.py has no 'Sin'; did you mean 'Sine'?"),
    "no class": (SINE, "x.py:math", "x.py: math is a module; give the name of a class"),
    "no step": (HEAD, "x.py:Sine", "x.py:6: Sine is no controller: it has no step("),
    "no dt": (
        SINE.replace("observation, dt)", "observation)"),
        "x.py",
        "x.py:20: Sine.step(self, observation) should be step(self, observation, dt)",
    ),
    "several": (SINE + "\n\nclass Cosine(Sine): ...\n", "x.py", "x.py:Sine, x.py:Cosine"),
    "constructor": (
        SINE.replace('"l_sho_pitch"', '"l_shoulder"'),
        "x.py",
        "x.py:15: unknown joint 'l_shoulder'; did you mean",
    ),
    "raises at once": (SINE.replace("self.begin)", "self.begun)"), "x.py", "x.py:21: Attribute"),
    "no command": (HEAD + "    def step(self, o, dt): ...\n", "x.py", "Sine.step returned noth"),
    "wrong shape": (
        SINE.replace("self.stance +", "[0.0] * 3 +"),
        "x.py",
        "x.py:22: ValueError",
    ),
    "nan": (SINE.replace("math.sin", "math.nan * "), "x.py", "commanded position nan for joint"),
    "exits at once": (
        SINE.replace("self.begin = observation.time", "raise SystemExit(2)"),
        "x.py",
        "x.py:18: it ends the program (SystemExit: 2)",
    ),
    "too few": (
        SINE.replace("self.stance + angle * self.way", "self.stance[:3]"),
        "x.py",
        "x.py:22: position: a command of shape (3,) for 20 joints; its shape has to be (20,)",
    ),
    "not an option": (
        SINE.replace("gain: float = 10.0", "gain"),
        "x.py",
        "x.py:6: Sine takes 'gain', which cannot be an option: annotate it",
    ),
    "not ours": (SINE.replace("gain", "seed"), "x.py", "has an option 'seed', and `windup run`"),
}


@pytest.mark.parametrize(("text", "what", "said"), WRONG.values(), ids=WRONG)
def test_what_is_wrong_is_one_line_before_anything_moves(
    here: Path, text: str | None, what: str, said: str
) -> None:
    if text is not None:
        (here / "x.py").write_text(text)
    assert said in refusal(["run", "op3", what])


def test_a_command_of_its_own_is_pointed_to() -> None:
    assert "walk is a command: `windup walk op3`" in refusal(["run", "op3", "walk"])


def test_nothing_to_run_is_told() -> None:
    assert "run: there is no behaviour 'nowhere'; give FILE.py" in refusal(
        ["run", "op3", "nowhere"]
    )
    assert "run: give FILE" in refusal(["run", "op3"])


LATE = SINE.replace(
    "        angle", "        if observation.time > 0.2:\n            1 / 0\n        angle"
)


def test_an_exception_in_mid_run_stops_the_robot_and_shows_its_traceback(
    here: Path, shell: Windup
) -> None:
    (here / "late.py").write_text(LATE)
    ran = shell("run", "op3", "late.py", "--json", "-")
    assert ran.status == 1
    message = "the controller failed: ZeroDivisionError: division by zero (late.py:22)"
    assert ran.json["error"] == {"kind": "Controller", "message": message, "exit_status": 1}
    assert ran.err.splitlines()[-1] == f"windup: {message}"
    assert 'File "late.py", line 22, in step' in ran.err
    assert "session.py" not in ran.err


def test_a_push_fells_what_does_not_care(sine: Path, shell: Windup) -> None:
    ran = shell("run", "op3", "sine.py", "--push", "6", "--push-at", "0.2", "--json", "-")
    assert (ran.status, ran.json["fell"], ran.json["reason"]) == (1, True, "fell")


def test_a_file_imports_what_lies_beside_it(here: Path, shell: Windup) -> None:
    (here / "sub").mkdir()
    text = SINE.replace("import math\n", "import math\n\nfrom far import GAIN\n")
    (here / "sub" / "far.py").write_text("GAIN = 5.0\n")
    (here / "sub" / "x.py").write_text(text.replace("= 10.0", "= GAIN"))
    ran = shell("run", "op3", "sub/x.py", "--seconds", "0.2", "--json", "-")
    assert (ran.status, ran.json["options"]["gain"]) == (0, 5.0), ran.err


def test_seeds_of_a_controller_are_rows(sine: Path, shell: Windup) -> None:
    ran = shell("run", "op3", "sine.py", "--seconds", "0.2", "--seeds", "2", "--json", "-")
    assert [row["seed"] for row in ran.json["rows"]] == [0, 1]
    assert ran.err.splitlines()[-1] == "2 of 2 seeds did what was asked"
