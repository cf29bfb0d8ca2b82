"""`windup run` with controllers that do wrong in the middle of a run."""

from pathlib import Path

import pytest

from tests.tools.conftest import Windup

LATE = """\
import numpy as np

from windup import JointCommand


class Late:
    def __init__(self, joints, stance):
        self.joints, self.stance = joints, stance

    def reset(self, observation):
        self.begin = observation.time

    def step(self, observation, dt):
        if observation.time > self.begin + 0.1:
            WRONG
        return JointCommand.of(self.joints, position=self.stance)
"""
WRONG = {
    "nothing": ("return None", "Late.step returned nothing; it should return JointCommand.of("),
    "an array": ("return self.stance", "Late.step returned a ndarray; it should return Joint"),
    "an exit": (
        "raise SystemExit(3)",
        "the controller failed: it ends the program (SystemExit: 3); raise an error instead (x.py",
    ),
    "wrong array": (
        "return JointCommand.of(self.joints, position=np.zeros(3))",
        "position: a command of shape (3,) for 20 joints; its shape has to be (20,) (x.py:15)",
    ),
    "wrong block": (
        "return JointCommand(np.zeros((5, 3)))",
        "a command of shape (5, 3) for 20 joints; its shape has to be (5, 20)",
    ),
}
PORTS = {"twin": (), "wire": ("--port", "twin://op3?clock=virtual")}


@pytest.mark.parametrize("port", PORTS.values(), ids=PORTS)
@pytest.mark.parametrize(("wrong", "said"), WRONG.values(), ids=WRONG)
def test_what_goes_wrong_in_a_later_tick_is_one_line(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    shell: Windup,
    wrong: str,
    said: str,
    port: tuple[str, ...],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("x.py").write_text(LATE.replace("WRONG", wrong))
    ran = shell("run", "op3", "x.py", "--seconds", "0.3", *port)
    assert ran.status == 1
    assert ran.err.splitlines()[-1].startswith(f"windup: {said}")
    assert "/control/" not in ran.err and "/hal/" not in ran.err


@pytest.mark.parametrize("port", PORTS.values(), ids=PORTS)
def test_what_was_clipped_is_in_the_last_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, shell: Windup, port: tuple[str, ...]
) -> None:
    monkeypatch.chdir(tmp_path)
    text = LATE.replace("WRONG", "pass").replace("self.stance)", "self.stance + self.far)")
    far = "        self.far = joints.array({'head_pan': 30.0})\n\n    def reset"
    Path("x.py").write_text(text.replace("\n    def reset", far, 1))
    ran = shell("run", "op3", "x.py", "--seconds", "0.2", *port, "--json", "-")
    ticks = ran.json["clamps"]["position"]
    assert ticks >= 25
    line = ran.err.splitlines()[-1]
    assert line.endswith(f"done; position of head_pan was clipped in {ticks} ticks")


def test_a_first_pose_beyond_the_limits_counts_as_clipped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, shell: Windup
) -> None:
    monkeypatch.chdir(tmp_path)
    text = LATE.replace("WRONG", "pass").replace("self.stance)", "self.stance + 30.0)")
    Path("x.py").write_text(text)
    ran = shell("run", "op3", "x.py", "--seconds", "0.2", *PORTS["wire"], "--json", "-")
    assert ran.json["clamps"]["position"] >= 1
    assert "(and of 19 other joints) was clipped in" in ran.err
