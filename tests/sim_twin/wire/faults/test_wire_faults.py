"""Each fault does what it says, by rate and by script, the same way every time."""

import math
from collections.abc import Callable, Iterator

import pytest
import serial

from tests.sim_twin.wire.wire_host1 import PING, READ, Host1, open_host1, statuses
from windup.sim_twin.wire import unregister_world
from windup.sim_twin.wire.faults.fault_rule import KINDS, make_rule
from windup.sim_twin.wire.faults.faults import Faults
from windup.sim_twin.wire.protocols.frames import Frame, Parser
from windup.sim_twin.wire.protocols.frames import encode as encode2
from windup.sim_twin.wire.protocols.frames1 import encode

BUS = "twin://bench?servos=STS3215:1-4&seed=5"
ASKED = encode(1, READ, b"\x38\x06")
ANSWER = 12  # bytes


@pytest.fixture
def host() -> Iterator[Host1]:
    with open_host1(BUS) as host:
        yield host


def faults_of(host: Host1) -> Faults:
    faults: Faults = host.port.world.faults
    return faults


def answers(host: Host1, count: int = 300) -> list[bytes]:
    return [host.raw(ASKED, 40) for _ in range(count)]


def whole(data: bytes) -> bool:
    return len(statuses(data)) == 1 and len(data) == ANSWER


def differ(got: bytes, right: bytes) -> int:
    """Return how many bytes are others; a checksum is one of them."""
    return sum(a != b for a, b in zip(got, right, strict=True))


@pytest.mark.parametrize(
    ("kind", "looks"),
    [
        ("drop", lambda got, right: got == b""),
        ("corrupt", lambda got, right: sum(a != b for a, b in zip(got, right, strict=True)) == 1),
        ("cut", lambda got, right: len(got) < len(right) and right.startswith(got)),
        ("noise", lambda got, right: len(got) > len(right) and got.endswith(right)),
        ("wrong_id", lambda got, right: statuses(got)[0].identifier not in (1, 254, 255)),
        ("wrong_length", lambda got, right: got[3] != right[3] and got[4:] == right[4:]),
        ("longer", lambda got, right: len(statuses(got)) == 1 and len(got) in (13, 14, 15)),
        ("shorter", lambda got, right: len(statuses(got)) == 1 and len(got) in (9, 10, 11)),
        ("zeros", lambda got, right: len(statuses(got)) == 1 and got[5:-1] == bytes(6)),
        ("jump", lambda got, right: len(statuses(got)) == 1 and differ(got, right) == 2),
        ("twice", lambda got, right: got == right + right),
        ("echo", lambda got, right: got == ASKED + right),
    ],
)
def test_what_it_does_to_an_answer(
    host: Host1, kind: str, looks: Callable[[bytes, bytes], bool]
) -> None:
    right = host.raw(ASKED)
    faults_of(host).add(make_rule(kind, 0.2))
    got = answers(host)
    hit = [data for data in got if data != right]
    assert all(looks(data, right) for data in hit)
    assert len(hit) == faults_of(host).counts[kind] == pytest.approx(60, abs=25)


def test_a_stale_answer_is_the_last_one_of_its_length(host: Host1) -> None:
    first, other = (encode(1, READ, bytes((address, 2))) for address in (56, 62))
    before = host.raw(first)
    assert host.raw(other) != before
    faults_of(host).stale(rate=1.0)
    assert host.raw(first) == host.raw(other)
    assert len(host.raw(ASKED)) == ANSWER


def test_behind_a_late_byte_all_is_late(host: Host1) -> None:
    faults_of(host).late_byte(rate=1.0, ids=[1])
    host.port.write(encode(254, 0x82, bytes((56, 2, 1, 2))))
    host.wait(0.015)
    assert host.port.in_waiting < 8
    host.wait(0.006)
    assert [f.identifier for f in statuses(host.port.read(16))] == [1, 2]


def test_what_nobody_answers_comes_back_too(host: Host1) -> None:
    faults_of(host).echo(rate=1.0)
    goal = encode(254, 0x83, bytes((42, 2, 1, 0, 8)))
    assert host.raw(goal) == goal


def test_a_late_answer_is_late_on_the_wire(host: Host1) -> None:
    faults_of(host).late(0.005, rate=1.0)
    began = host.now
    host.port.write(ASKED)
    host.port.read(1)
    assert host.now - began == pytest.approx(0.005 + (len(ASKED) + 1) * 1e-5)


def test_behind_a_late_answer_the_others_wait(host: Host1) -> None:
    faults_of(host).late(0.005, ids=[1], rate=1.0)
    assert [f.identifier for f in statuses(host.sync_read(56, 2, 1, 2, 3))] == [1, 2, 3]


def test_a_delayed_answer_comes_in_one_piece(host: Host1) -> None:
    faults_of(host).delay(0.016, rate=1.0)
    began = host.now
    host.port.write(ASKED)
    assert host.port.read(1) and host.port.in_waiting == ANSWER - 1
    assert host.now - began == pytest.approx(0.016 + len(ASKED) * 1e-5)


def test_a_delay_holds_back_what_comes_behind_it(host: Host1) -> None:
    faults_of(host).delay(0.016, ids=[1], rate=1.0)
    host.port.write(encode(254, 0x82, bytes((56, 2, 1, 2))))
    host.wait(0.015)
    assert host.port.in_waiting == 0
    host.wait(0.002)
    assert host.port.in_waiting == 16


def test_glued_answers_come_together(host: Host1) -> None:
    faults_of(host).glue(ids=[1], rate=1.0)
    host.port.write(encode(254, 0x82, bytes((56, 2, 1, 2))))
    end = (len(ASKED) + 2 + 16) * 1e-5
    host.wait(end - 2e-5)
    assert host.port.in_waiting == 0
    host.wait(5e-5)
    assert host.port.in_waiting == 16
    host.raw(b"")
    host.port.write(ASKED)
    host.wait(0.003)
    assert host.port.in_waiting == 0
    host.wait(0.002)
    assert host.port.in_waiting == ANSWER


def test_only_those_named_are_hit() -> None:
    with open_host1(f"{BUS}&faults=drop:1:ids=2;4") as host:
        assert [f.identifier for f in statuses(host.sync_read(56, 2, 1, 2, 3, 4))] == [1, 3]


def test_a_script_hits_the_first_answer_from_its_time_on() -> None:
    with open_host1(f"{BUS}&faults=drop:at=0.5;1.5:ids=1") as host:
        assert whole(host.raw(ASKED, ANSWER))
        host.wait(0.5)
        assert [bool(host.raw(ASKED, ANSWER)) for _ in range(3)] == [False, True, True]
        host.wait(1.0)
        assert [bool(host.raw(ASKED, ANSWER)) for _ in range(3)] == [False, True, True]
        assert [hit[1:] for hit in faults_of(host).hits] == [("drop", "bench", 1)] * 2


def test_a_dead_servo_lets_go_and_never_answers_again(host: Host1) -> None:
    host.write(2, "torque_enable", 1)
    faults_of(host).dead(ids=[2], at=host.now + 0.1)
    assert len(host.ask(2, PING)) == 1
    host.wait(0.2)
    assert host.ask(2, PING) == []
    assert not host.servo(2).driving
    host.world.set_supply(0.0)
    host.world.set_supply(7.4)
    host.wait(1.0)
    assert [len(host.ask(k, PING)) for k in (1, 2, 3)] == [1, 0, 1]


def test_a_reset_switches_the_torque_off_and_takes_a_while(host: Host1) -> None:
    host.write(3, "goal_position", 2100)
    faults_of(host).reset(ids=[3], at=host.now + 0.1)
    host.wait(0.1)
    assert host.ask(3, PING) == []
    host.wait(0.5)
    assert host.read(3, "torque_enable") == 0


def test_a_brown_out_resets_everything_or_alarms(host: Host1) -> None:
    host.write(1, "torque_enable", 1)
    faults_of(host).brown_out(at=host.now + 0.1, seconds=0.1)
    host.wait(0.15)
    assert host.ask(1, PING) == []
    host.wait(0.5)
    assert host.read(1, "torque_enable") == 0
    faults_of(host).brown_out(volts=3.5, at=host.now + 0.1, seconds=0.1)
    host.wait(0.15)
    assert host.read(1, "status") == 1
    host.wait(0.2)
    assert host.read(1, "status") == 0


def test_an_overload_is_taken_for_real(host: Host1) -> None:
    host.write(1, "torque_enable", 1)
    faults_of(host).overload(ids=[1], at=host.now + 0.01)
    host.wait(0.02)
    assert host.ask(1, PING)[0].instruction == 0x20


@pytest.mark.parametrize("kind", ["dead", "reset", "overload", "unplug", "brown_out"])
def test_what_befalls_servos_can_come_by_rate_too(kind: str) -> None:
    with open_host1(f"{BUS}&world={kind}") as host:
        faults_of(host).add(make_rule(kind, 1.0, ids=[1] if kind != "unplug" else None))
        host.port.write(ASKED)
        if kind == "unplug":
            with pytest.raises(serial.SerialException):
                host.port.read(ANSWER)
        else:
            got = host.port.read(ANSWER)
            assert whole(got) if kind == "overload" else got == b""
        assert faults_of(host).counts[kind] == 1
    unregister_world(kind)


def test_unplugging_kills_the_port_and_plugging_in_lets_it_be_opened_again() -> None:
    url = f"{BUS}&faults=unplug:at=0.1:seconds=0.2"
    with open_host1(url) as host:
        host.write(1, "goal_position", 2100)
        host.port.timeout = 1.0
        with pytest.raises(serial.SerialException, match="unplugged"):
            host.port.read(1)
        clock = host.port.clock
        assert clock.now() == pytest.approx(0.1)
        with pytest.raises(serial.SerialException, match="unplugged"):
            host.port.write(ASKED)
        world = host.world
    with pytest.raises(serial.SerialException, match="is unplugged"):
        serial.serial_for_url(url)
    with open_host1(BUS) as other:
        assert other.world is not world  # who opens something else gets something else
    clock.wait_until(0.31)
    with open_host1(url) as again:
        assert again.world is world
        assert again.read(1, "torque_enable") == 1
        assert again.read(1, "present_position") == pytest.approx(2100, abs=3)


def test_an_adapter_that_never_comes_back() -> None:
    with open_host1(f"{BUS}&world=gone") as host:
        faults_of(host).unplug(at=0.1, seconds=math.inf)
        host.wait(100.0)
        assert not host.port.bus.plugged
    unregister_world("gone")


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "button"])
def test_the_same_seed_brings_the_same_bytes(kind: str) -> None:
    def run() -> list[bytes]:
        with open_host1(f"{BUS}&faults={kind}:0.05&imu=rvc&world=again") as host:
            got = []
            try:
                for _ in range(60):
                    got.append(host.sync_read(56, 6, 1, 2, 3, 4))
            except serial.SerialException:
                got.append(b"unplugged")
            got.append(repr([*faults_of(host).hits]).encode())
        unregister_world("again")
        return got

    one, other = run(), run()
    assert one == other
    assert one[-1] != b"[]"


def test_faults_of_protocol_2_keep_to_its_frames() -> None:
    url = "twin://bench?servos=XM430-W350:1&faults=wrong_id:1,wrong_length:at=1"
    with serial.serial_for_url(url, baudrate=1_000_000, timeout=0.02) as port:
        port.write(encode2(1, 1))
        (status,) = Parser().feed(port.read(100))
        assert isinstance(status, Frame) and status.identifier != 1


def test_clearing_ends_it(host: Host1) -> None:
    faults = faults_of(host).drop(rate=1.0).unplug(at=host.now + 0.1)
    faults.clear()
    host.wait(0.2)
    assert whole(host.raw(ASKED))
