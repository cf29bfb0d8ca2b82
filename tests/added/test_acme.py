"""Servos and a robot of somebody else do what Windup's own do."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.added.conftest import HERE, Python
from tests.tools.conftest import Windup
from windup.hal.bus.bus import Bus
from windup.hal.errors import TorqueLostError, UnknownNameError
from windup.hal.families import family_of, servo_model, servo_names
from windup.robots import load_robot, robot_names
from windup.tools.testing.servo_bus import ServoBus

pytestmark = pytest.mark.usefixtures("acme")


def test_the_family_takes_at_most_sixty_lines() -> None:
    files = (HERE / "acme_servos").glob("*.py")
    assert sum(len(path.read_text().splitlines()) for path in files) <= 60


def test_its_servos_are_known(monkeypatch: pytest.MonkeyPatch, acme: Path) -> None:
    assert servo_model("A1").model_number == 4711 and "A1" in servo_names()
    assert family_of("A1").name == "Acme"
    monkeypatch.setattr(sys, "path", [entry for entry in sys.path if entry != str(acme)])
    with pytest.raises(UnknownNameError, match="unknown servo 'A1'"):
        servo_model("A1")


def test_its_robot_is_listed_and_loaded(shell: Windup) -> None:
    assert "acme_arm" in robot_names()
    listed = {row["robot"]: row for row in shell("robots", "--json", "-").json["robots"]}
    assert listed["acme_arm"]["gaits"] == ["nod"] and "op3" in listed
    arm = load_robot("acme_arm")
    assert [mount.model.name for mount in arm.servos if mount is not None] == ["A1", "A1"]
    assert shell("check", "acme_arm").status == 0


def test_its_robot_plays_a_gait_on_the_twin_and_on_the_wire(shell: Windup) -> None:
    for port in ([], ["--port", "twin://acme_arm"]):
        ran = shell("play", "acme_arm", "nod", *port, "--json", "-")
        assert ran.status == 0, ran.err


def test_its_servos_are_scanned_on_an_emulated_bus(shell: Windup) -> None:
    ran = shell("scan", "twin://bench?servos=A1:1-3", "--baud", 1_000_000, "--json", "-")
    rows = ran.json["servos"]
    assert [(row["id"], row["model"], row["voltage_v"]) for row in rows] == [
        (id, "A1", 12.0) for id in (1, 2, 3)
    ]
    assert ran.json["unknown"] == ran.json["not_understood"] == []


def test_the_driver_moves_its_emulated_servos() -> None:
    with ServoBus(servos="A1:1-3", return_delay=0) as bus:
        driver = Bus(bus.port(), family_of("A1"))
        registers = driver.family.registers
        driver.write(2, registers["torque_enable"], 1)
        driver.sync_write(registers["goal_position"], {2: 3000})
        bus.wait(1.0)
        counts, valid = driver.sync_read((1, 2, 3), registers["present_position"])
        assert valid.all() and np.abs(counts - [2048, 3000, 2048]).max() < 20
        assert [bus.servo(id).driving for id in (1, 2, 3)] == [False, True, False]


def test_an_overload_of_its_servo_is_seen_as_one() -> None:
    with ServoBus("acme_arm") as bus:
        bus.faults.overload(ids=[2], at=1.0)
        with pytest.raises(TorqueLostError, match=r"elbow.*overload"):
            bus.robot().stand(3.0)


def test_a_loss_of_power_is_seen_by_its_servos() -> None:
    with ServoBus(servos="A1:1") as bus:
        bus.servo(1).set_supply(5.0, 0.0)
        bus.wait(0.1)
        driver = Bus(bus.port(), family_of("A1"))
        assert driver.read(1, driver.family.registers["present_voltage"]) == 50
        assert bus.servo(1).read(0, 1, 0.1)[0] == 1


def test_its_servos_are_served_to_other_programs(acme: Path) -> None:
    words = ["emulate", "--servos", "A1:1-3", "--tcp", "0"]
    text = f"import sys; sys.path.insert(0, {str(acme)!r})\n"
    text += f"from windup.tools.cli import main; main({words})"
    with subprocess.Popen([sys.executable, "-c", text], stderr=subprocess.PIPE, text=True) as ran:
        assert ran.stderr is not None
        assert ran.stderr.readline().startswith("bus 'bench' (3 devices at 1000000 baud) on socket")
        ran.terminate()
        assert ran.wait(20) == 0


@pytest.mark.parametrize(
    "program",
    [
        "import windup.hal",
        "from windup.tools.cli import run; run(['--help'])",
        "from windup.tools.cli import run; assert run(['robots']) == 0",
        "from windup.robots import load_robot; load_robot('op3')",
    ],
    ids=["hal", "help", "robots", "op3"],
)
def test_its_servos_are_imported_by_nobody_who_does_not_need_them(
    program: str, python: Python, acme: Path
) -> None:
    ran = python(f"{program}; import sys; assert 'acme_servos' not in sys.modules", acme)
    assert ran.returncode == 0, ran.stderr
