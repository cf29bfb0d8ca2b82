"""Broken packages of somebody else are one line each, and stop nobody who does not need them."""

import dataclasses
from pathlib import Path

import pytest

from tests.added.acme_servos.family import FAMILY
from tests.added.conftest import Python
from tests.added.install import install
from tests.tools.conftest import Windup
from windup.hal.errors import PluginError
from windup.hal.families import FAMILIES, family_of, plain_family
from windup.hal.families.added import check_added
from windup.hal.registers import Register
from windup.robots import load_robot
from windup.sim_twin.wire import build_world, parse_address

LINE = "broken 1.0: entry point {name} = {value} of {group}: {why}"
HELP = "from windup.tools.cli import main; main(['--help'])"
ROBOTS = "from windup.tools.cli import main; main(['robots'])"
SERVOS = """
from windup.hal.errors import UnknownNameError
from windup.hal.families import servo_model

assert servo_model("XL430-W250").model_number == 1060
try:
    servo_model("A2")
except UnknownNameError as error:
    print(error)
"""


def test_a_broken_robot_is_said_and_the_others_are_listed(python: Python, tmp_path: Path) -> None:
    install(tmp_path / "a", "broken", {"windup.robots": {"op3": "none_b", "wreck": "none_a"}})
    ran = python(ROBOTS, tmp_path / "a")
    assert ran.returncode == 0 and "duck" in ran.stderr
    said = [line for line in ran.stderr.splitlines() if line.startswith("windup: ")]
    why = "Windup has this name itself; choose another"
    gone = "ModuleNotFoundError: No module named 'none_a'"
    assert said == [
        "windup: " + LINE.format(name="op3", value="none_b", group="windup.robots", why=why),
        "windup: " + LINE.format(name="wreck", value="none_a", group="windup.robots", why=gone),
    ]
    assert python(HELP, tmp_path / "a").stderr == ""


def test_broken_servos_are_said_where_a_servo_is_looked_for(python: Python, tmp_path: Path) -> None:
    install(tmp_path / "a", "broken", {"windup.servos": {"acme": "none_c:FAMILY"}})
    ran = python(SERVOS, tmp_path / "a")
    why = "ModuleNotFoundError: No module named 'none_c'"
    line = LINE.format(name="acme", value="none_c:FAMILY", group="windup.servos", why=why)
    assert ran.stderr.splitlines() == [line]
    assert ran.stdout.startswith("unknown servo 'A2'; ")
    assert python(HELP, tmp_path / "a").stderr == ""


def test_a_robot_without_its_file_is_refused_by_its_distribution(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, shell: Windup
) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "empty_d").mkdir()
    install(tmp_path, "broken", {"windup.robots": {"wreck": "empty_d", "text": "os:sep"}})
    why = f"there is no robot.toml in {tmp_path / 'empty_d'}"
    line = LINE.format(name="wreck", value="empty_d", group="windup.robots", why=why)
    assert shell("stand", "wreck") == shell("walk", "wreck")
    ran = shell("stand", "wreck")
    assert (ran.status, ran.err) == (2, f"windup: {line}\n")
    with pytest.raises(
        PluginError, match=r"should be a package with a robot\.toml or a pathlib\.Path"
    ):
        load_robot("text")


def test_a_robot_whose_file_is_wrong_is_left_out_of_the_list(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, shell: Windup, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "wrong_e").mkdir()
    (tmp_path / "wrong_e" / "robot.toml").write_text("nonsense = 1\n")
    install(tmp_path, "broken", {"windup.robots": {"wreck": "wrong_e"}})
    ran = shell("robots", "--json", "-")
    assert ran.status == 0 and "op3" in {row["robot"] for row in ran.json["robots"]}
    assert [str(tmp_path / "wrong_e") in record.getMessage() for record in caplog.records] == [True]


WRONG = {
    "no family": (4711, "should be a windup.hal.families.Family, and is of type int"),
    "a name of ours": (
        dataclasses.replace(FAMILY, name="Feetech STS"),
        "Windup has a family 'Feetech STS' itself; choose another name",
    ),
    "a model of ours": (
        dataclasses.replace(FAMILY, numbers={777: "STS3215"}),
        "Windup has a servo model 'STS3215' itself; choose another name",
    ),
    "no models": (dataclasses.replace(FAMILY, models=[]), "family 'Acme' has no models"),
    "no number": (
        dataclasses.replace(FAMILY, numbers={1: "A2"}),
        "model 'A1' has no entry in the numbers of the family",
    ),
    "no register": (
        dataclasses.replace(FAMILY, errors_in_answers=False),
        "model 'A1' has no register hardware_error",
    ),
}


@pytest.mark.parametrize(("found", "why"), WRONG.values(), ids=WRONG)
def test_a_family_that_cannot_be_used_says_why(found: object, why: str) -> None:
    with pytest.raises(ValueError, match=f"^{why}"):
        check_added(found, FAMILIES)


@pytest.mark.parametrize(
    ("emulation", "why"),
    [
        ("", " has no emulation: its servos are driven on a real port only"),
        ("none_f:EMULATION", ": emulation none_f:EMULATION: ModuleNotFoundError: No module named"),
        ("os:sep", ": emulation os:sep should be a windup.sim_twin.wire.world.emulation.Emulation"),
    ],
)
def test_a_family_that_cannot_be_emulated_says_why(
    emulation: str, why: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    name = f"text_{len(emulation)}"
    text = f"""
    from dataclasses import replace
    from tests.added.acme_servos.family import FAMILY
    FAMILY = replace(FAMILY, emulation={emulation!r})
    """
    install(tmp_path, "mute", {"windup.servos": {"acme": f"{name}:FAMILY"}}, {name: text})
    with pytest.raises(PluginError, match=f"^mute 1.0: family 'Acme'{why}"):
        build_world(parse_address("twin://bench?servos=A1:1"))


def test_registers_in_another_order_need_blocks_of_their_own() -> None:
    registers = {**FAMILY.registers, "torque_enable": Register("torque_enable", 40, 1)}
    with pytest.raises(ValueError, match="torque_enable has to be below the registers of position"):
        plain_family("Acme", "acme", FAMILY.protocol, [*registers.values()], FAMILY.models, {}, {})
    del registers["present_load"]
    with pytest.raises(ValueError, match="family 'Acme' has no register present_load"):
        plain_family("Acme", "acme", FAMILY.protocol, [*registers.values()], FAMILY.models, {}, {})


def test_no_other_read_has_the_size_of_the_torque_read() -> None:
    sizes = [block.size for block in (FAMILY.state, FAMILY.check, FAMILY.health) if block]
    assert sizes == [6, 14, 8] and FAMILY.torque_bytes == 3
    assert family_of("XL430-W250").torque_bytes not in (1, 2, 4)
