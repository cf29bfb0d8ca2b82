"""The guardian against an emulated bus in a process of its own. Nothing here is timed."""

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TypeVar

import pytest

from hal.bus import Bus
from hal.errors import HardwareError, PortError
from hal.families import FEETECH_STS
from hal.guardian import Charge, Guardian, carry_out, guardian_for
from hal.open_port import open_port
from hal.port import Port
from hal.registers import Register
from hal.servos import servo_model
from tests.hal.fake_bus1 import STS
from tests.hal.mixed_robot import Wires, mount, robot
from tools.robot import Robot

IDS = {1: "STS3215-7.4V", 2: "STS3215-7.4V"}
TORQUE = FEETECH_STS.registers["torque_enable"]
T = TypeVar("T")
GOAL = FEETECH_STS.registers["goal_position"]
EMULATE = [sys.executable, "-c", "from tools.cli import main; main()", "emulate"]

HOST = """
import json, sys, time
from hal.bus import Bus
from hal.errors import HardwareError
from hal.families import FEETECH_STS
from hal.guardian import Charge, Guardian
from hal.open_port import open_port
from hal.port import Port
from hal.registers import Register
path, policy = sys.argv[1:]
port = open_port(path, 1_000_000)
bus = Bus(port, FEETECH_STS)
guardian = Guardian([Charge(path, 1_000_000, {1: "STS3215-7.4V", 2: "STS3215-7.4V"})], policy)
for id in (1, 2):
    for _ in range(20):
        try:
            bus.write(id, FEETECH_STS.registers["torque_enable"], 1)
            break
        except HardwareError:
            pass
    bus.command(id, FEETECH_STS.registers["goal_position"], 3000)
print(guardian._process.pid, flush=True)
read = FEETECH_STS.dialect.read([FEETECH_STS.state.span(id) for id in (1, 2)])
while True:
    bus.exchange.request(read)
    bus.exchange.collect()
"""


@contextmanager
def emulated(*arguments: str) -> "Iterator[subprocess.Popen[str]]":
    with subprocess.Popen([*EMULATE, *arguments], stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        for line in process.stderr:
            if line.startswith("Ctrl-C"):
                break
        try:
            yield process
        finally:
            process.kill()


@pytest.fixture(scope="module")
def sts_bus(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    path = tmp_path_factory.mktemp("guardian") / "bus"
    with emulated("twin://bench?servos=STS3215:1-2", "--pty", str(path)):
        yield path


def patiently(ask: Callable[[], T]) -> T:
    """Ask again where a busy machine has kept a servo from its answer."""
    for _ in range(20):
        with suppress(HardwareError):
            return ask()
    return ask()


def switch_on(port: Port, id: int) -> None:
    patiently(lambda: Bus(port, FEETECH_STS).write(id, TORQUE, 1))


def show(port: Port, register: Register) -> list[int]:
    bus = Bus(port, FEETECH_STS)
    return [patiently(partial(bus.read, id, register)) for id in IDS]


def runs(number: int) -> bool:
    """Does the process still run?"""
    try:
        return Path(f"/proc/{number}/stat").read_text().split(") ")[1][0] != "Z"
    except FileNotFoundError:
        return False


@pytest.mark.parametrize("policy", ["limp", "crouch", "hold"])
def test_it_stops_the_servos_of_a_host_that_was_killed(sts_bus: Path, policy: str) -> None:
    host = subprocess.Popen(
        [sys.executable, "-c", HOST, str(sts_bus), policy],
        stdout=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        text=True,
    )
    assert host.stdout is not None
    guardian = int(host.stdout.readline())
    host.kill()
    host.wait()
    host.stdout.close()
    while runs(guardian):
        pass
    with open_port(str(sts_bus), 1_000_000) as port:
        on, goals = show(port, TORQUE), show(port, GOAL)
    if policy == "hold":
        assert on == [1, 1] and 3000 not in goals
    else:
        assert on == [0, 0]


def test_a_host_that_lets_it_go_leaves_the_servos_alone(sts_bus: Path) -> None:
    guardian = Guardian([Charge(str(sts_bus), 1_000_000, IDS)], "limp")
    assert guardian.alive
    with open_port(str(sts_bus), 1_000_000) as port:
        switch_on(port, 1)
        guardian.release()
        assert not guardian.alive
        assert show(port, TORQUE)[0] == 1


def test_a_port_that_still_has_a_lock_on_it_is_taken_all_the_same(sts_bus: Path) -> None:
    with open_port(str(sts_bus), 1_000_000) as port:
        switch_on(port, 1)
        with pytest.raises(PortError, match="in use"):
            open_port(str(sts_bus))
        assert carry_out([Charge(str(sts_bus), 1_000_000, IDS)], "limp")
        assert show(port, TORQUE)[0] == 0


def test_a_bus_that_stays_away_is_said_and_does_not_keep_another_from_its_stop(
    sts_bus: Path,
) -> None:
    charges = [Charge("/dev/ttyNONE", 1_000_000, IDS), Charge(str(sts_bus), 1_000_000, IDS)]
    with open_port(str(sts_bus), 1_000_000) as port:
        switch_on(port, 2)
        assert not carry_out(charges, "limp", patience=0.5)
        assert show(port, TORQUE)[1] == 0


def test_wires_of_this_process_and_servos_with_a_watchdog_need_none(tmp_path: Path) -> None:
    wires = Wires()
    wires.add("legs", {1: STS})
    backend = robot(wires, [mount(STS, "legs", 1)])
    backend.connect()
    assert guardian_for(backend, "limp") is None
    backend.disconnect()
    path = str(tmp_path / "bus")
    with emulated("twin://bench?servos=XM430-W350:1", "--pty", path):
        wires.add("arms", {1: servo_model("XM430-W350")}, protocol=2)
        backend = robot(wires, [mount(servo_model("XM430-W350"), "arms", 1)])
        backend._opener = lambda url, baud: open_port(path, baud)
        backend.connect()
        assert guardian_for(backend, "limp") is None
        backend.disconnect()


def test_a_duck_on_a_terminal_has_one_while_it_is_armed(tmp_path: Path) -> None:
    path = tmp_path / "bus"
    with emulated("duck", "--pty", str(path)):
        port = f"body={path}-body,imu={path}-imu"
        with patiently(lambda: Robot.open("duck", port=port, arm=True)) as duck:
            assert duck.guardian is None
            patiently(duck.arm)
            assert duck.guardian is not None and duck.guardian.alive
            watching = duck.guardian
            duck.stop(limp=True)
            assert duck.guardian is None and not watching.alive


def test_orders_that_nobody_gives_are_no_orders() -> None:
    ran = subprocess.run(
        [sys.executable, "-P", "-c", "from hal.guardian import main; main()"],
        input=json.dumps({"host": os.getpid(), "policy": "limp", "charges": []}).encode() + b"\nx",
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
    )
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, b"r", b"")
