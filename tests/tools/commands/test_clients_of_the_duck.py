"""Unmodified clients on `windup emulate duck`. Nothing here is timed; a busy machine may be late,
so what is not answered is asked again, as their own callers do."""

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import pytest
import rustypot
import scservo_sdk as scs

from tests.tools.commands.test_emulate import said, start
from windup.robots import load_robot

IDS = [20, 21, 22, 23, 24, 30, 31, 32, 33, 10, 11, 12, 13, 14]
MODEL = 777  # an STS3215, as LeRobot's table of models has it
RETURN_DELAY, OFFSET, TORQUE, GOAL, LOCK, PRESENT = 7, 31, 40, 42, 55, 56


@pytest.fixture(scope="module")
def bus(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    path = tmp_path_factory.mktemp("duck") / "bus"
    with start("duck", "--pty", str(path)) as process:
        words = next(line for line in said(process) if "14 devices" in line)
        yield str(Path(words.split(" on ")[1].split(";")[0]))
        process.kill()


@pytest.fixture
def port(bus: str) -> Iterator[Any]:
    handler = scs.PortHandler(bus)
    assert handler.openPort()
    assert handler.setBaudRate(1_000_000)
    yield handler
    handler.closePort()


def again(ask: Callable[[], Any], good: Callable[[Any], bool], tries: int = 500) -> Any:
    answer: Any = None
    for _ in range(tries):
        # The SDK's ping takes a late answer to the question before for its own, and trips over it.
        with suppress(IndexError):
            if good(answer := ask()):
                return answer
    raise AssertionError(f"no good answer in {tries}: {answer}")


def read(packets: Any, port: Any, id: int, address: int, size: int) -> int:
    call = packets.read1ByteTxRx if size == 1 else packets.read2ByteTxRx
    return int(again(lambda: call(port, id, address), lambda a: a[1:] == (0, 0))[0])


def write(packets: Any, port: Any, id: int, address: int, size: int, value: int) -> None:
    call = packets.write1ByteTxRx if size == 1 else packets.write2ByteTxRx
    again(lambda: call(port, id, address, value), lambda a: a == (0, 0))


def positions(packets: Any, port: Any) -> list[int]:
    sync = scs.GroupSyncRead(port, packets, PRESENT, 2)
    for id in IDS:
        sync.addParam(id)
    again(sync.txRxPacket, lambda a: a == scs.COMM_SUCCESS)
    return [sync.getData(id, PRESENT, 2) for id in IDS]


def test_lerobots_handshake_and_settings(port: Any) -> None:
    packets = scs.PacketHandler(0)
    for id in IDS:
        model, *_ = again(partial(packets.ping, port, id), lambda a: a[1:] == (0, 0))
        assert model == MODEL
    write(packets, port, 20, TORQUE, 1, 0)
    write(packets, port, 20, LOCK, 1, 0)
    write(packets, port, 20, RETURN_DELAY, 1, 0)
    assert read(packets, port, 20, RETURN_DELAY, 1) == 0
    write(packets, port, 20, LOCK, 1, 1)
    assert read(packets, port, 20, LOCK, 1) == 1


@pytest.mark.parametrize("offset", [-100, 100])
def test_lerobots_homing_offset_has_its_sign_in_bit_11(port: Any, offset: int) -> None:
    packets = scs.PacketHandler(0)
    write(packets, port, 33, TORQUE, 1, 0)
    write(packets, port, 33, LOCK, 1, 0)
    write(packets, port, 33, OFFSET, 2, 0)
    before = read(packets, port, 33, PRESENT, 2)
    write(packets, port, 33, OFFSET, 2, abs(offset) | (offset < 0) << 11)
    after = read(packets, port, 33, PRESENT, 2)
    write(packets, port, 33, OFFSET, 2, 0)
    write(packets, port, 33, LOCK, 1, 1)
    assert before - after == pytest.approx(offset, abs=20)  # the limp head sinks meanwhile


def test_128_makes_the_middle_of_where_the_head_is(port: Any) -> None:
    packets = scs.PacketHandler(0)
    write(packets, port, 32, TORQUE, 1, 128)
    assert read(packets, port, 32, PRESENT, 2) == pytest.approx(2048, abs=20)


def test_sync_write_moves_what_sync_read_shows(port: Any) -> None:
    packets = scs.PacketHandler(0)
    goals = positions(packets, port)
    goals[IDS.index(31)] += 60
    sync = scs.GroupSyncWrite(port, packets, GOAL, 2)
    for id, goal in zip(IDS, goals, strict=True):
        sync.addParam(id, [goal & 255, goal >> 8])
    assert sync.txPacket() == scs.COMM_SUCCESS
    again(
        lambda: positions(packets, port)[IDS.index(31)],
        lambda at: abs(at - goals[IDS.index(31)]) < 30,
        tries=2000,
    )


@pytest.fixture
def pot(bus: str) -> Any:
    return rustypot.Sts3215PyController(bus, 1_000_000, 0.5)


def asked(call: Callable[[], Any]) -> Any:
    """Return what rustypot says; it raises where an answer is late."""
    for _ in range(20):
        try:
            return call()
        except RuntimeError as error:
            late = error
    raise late


def test_rustypot_reads_what_the_duck_has(pot: Any) -> None:
    assert sorted(IDS) == sorted(mount.id for mount in load_robot("duck").servos if mount)
    assert all(asked(partial(pot.ping, id)) for id in IDS)
    assert asked(partial(pot.read_model, 20)) == [MODEL]
    at = asked(partial(pot.sync_read_raw_present_position, IDS))
    assert len(at) == len(IDS)
    assert all(0 <= counts < 4096 for counts in at)
    assert asked(partial(pot.read_present_voltage, 20))[0] == pytest.approx(74, abs=2)


def test_rustypot_writes_and_reads_back(pot: Any) -> None:
    asked(partial(pot.write_torque_enable, 30, False))
    asked(partial(pot.write_p_coefficient, 30, 12))
    assert asked(partial(pot.read_p_coefficient, 30)) == [12]
    asked(partial(pot.write_p_coefficient, 30, 32))


@pytest.mark.parametrize("offset", [-100, 100])
def test_rustypot_has_its_offsets_signed_as_the_servo_has(pot: Any, offset: int) -> None:
    asked(partial(pot.write_torque_enable, 30, False))
    asked(partial(pot.write_lock, 30, False))
    asked(partial(pot.write_raw_offset, 30, 0))
    before = asked(partial(pot.read_raw_present_position, 30))[0]
    asked(partial(pot.write_raw_offset, 30, abs(offset) | (offset < 0) << 11))
    after = asked(partial(pot.read_raw_present_position, 30))[0]
    asked(partial(pot.write_raw_offset, 30, 0))
    asked(partial(pot.write_lock, 30, True))
    assert before - after == pytest.approx(offset, abs=20)


@pytest.mark.parametrize("step", [80, -80])
def test_rustypot_sync_writes_goals_and_sees_the_speed_with_its_sign(pot: Any, step: int) -> None:
    here = asked(partial(pot.read_raw_present_position, 32))[0]
    pot.sync_write_raw_goal_position([32], [here + step])
    fastest = 0.0

    def at() -> int:
        nonlocal fastest
        speed = asked(partial(pot.read_present_speed, 32))[0]
        fastest = max(fastest, speed, key=abs)
        return int(asked(partial(pot.read_raw_present_position, 32))[0])

    again(at, lambda position: abs(position - here - step) <= 30, tries=2000)
    assert fastest * step > 0.0


def test_ftservos_own_sdk_in_a_process_of_its_own(bus: str) -> None:
    # It has the name of feetech-servo-sdk, so it lies beside the environment, see the Makefile.
    beside = Path(sys.prefix) / "ftservo"
    assert beside.is_dir(), "ftservo-python-sdk is not installed: run `make .venv/clients.stamp`"
    client = Path(__file__).parents[1] / "ftservo_client.py"
    ran = subprocess.run(
        [sys.executable, str(client), bus],
        env={**os.environ, "PYTHONPATH": str(beside)},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert ran.returncode == 0, ran.stderr
    said = json.loads(ran.stdout)
    assert Path(said["sdk"]).is_relative_to(beside)
    assert sorted(said["found"]) == sorted([id, MODEL] for id in IDS)
    assert said["offset"] == pytest.approx(-100, abs=20)
    assert said["middle"] == pytest.approx(2048, abs=20)
    assert said["lock"] == [0, 1]
    assert said["speeds"][0] > 0 > said["speeds"][1]
    assert said["turned"] == pytest.approx([100, -100], abs=30)
    assert said["sync"] == pytest.approx([2048] * 3, abs=40)
