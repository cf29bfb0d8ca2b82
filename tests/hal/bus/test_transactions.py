import numpy as np
import pytest

from tests.hal.fake_bus import FakeSerial, fake_port
from windup.hal.bus.transactions import LATE_ANSWER_TIME, MAX_DOUBTED, TURNAROUND, BusTransactions
from windup.hal.port.port import Port
from windup.hal.protocols import protocol2
from windup.hal.protocols.batched import BlockRead
from windup.hal.protocols.protocol2 import Span

IDS = list(range(1, 21))


def exchange_of(serial: FakeSerial, port: Port) -> BusTransactions:
    serial.latency = port.latency = 1e-3
    exchange = BusTransactions(port)
    exchange.turnaround = TURNAROUND
    return exchange


def cycle(exchange: BusTransactions, read: BlockRead) -> float:
    start = exchange.port.clock.now()
    exchange.request(read)
    exchange.collect()
    return exchange.port.clock.now() - start


@pytest.fixture
def read() -> BlockRead:
    return BlockRead([Span(id, 126, 10) for id in IDS])


def wire_time(read: BlockRead, baud: float = 1e6) -> float:
    return (len(read.request) + read.length) * 10.0 / baud


def test_a_cycle_takes_its_time_on_the_wire_and_no_more(read: BlockRead) -> None:
    serial, port = fake_port(IDS)
    assert cycle(exchange_of(serial, port), read) == pytest.approx(wire_time(read))
    assert read.valid.all()


@pytest.mark.parametrize("dead", [1, 7, 20])
def test_a_missing_servo_costs_4_ms_and_no_other_servo_for_ever(read: BlockRead, dead: int) -> None:
    serial, port = fake_port(IDS)
    exchange = exchange_of(serial, port)
    serial.silent.add(dead)
    times = [cycle(exchange, read) for _ in range(300)]
    assert max(times) <= wire_time(read) + 4e-3
    assert np.flatnonzero(~read.valid).tolist() == [dead - 1]
    assert exchange.errors["no answer"] == 300


def test_stuffed_replies_are_read_to_their_end_at_once(read: BlockRead) -> None:
    serial, port = fake_port(IDS)
    exchange = exchange_of(serial, port)
    for id in IDS[::2]:
        serial.put(id, 126, -1, 2)
        serial.put(id, 128, -3, 4)  # ff ff fd ff ff ff
    stuffing = 10 * 10.0 / 1e6
    assert cycle(exchange, read) == pytest.approx(wire_time(read) + stuffing)
    assert read.valid.all()
    assert read.column(2, "<i4")[0] == -3


def test_a_corrupt_reply_costs_that_reply(read: BlockRead) -> None:
    serial, port = fake_port(IDS)
    exchange = exchange_of(serial, port)
    serial.spoil = lambda id, frame: frame[:-1] + bytes([frame[-1] ^ 1]) if id == 4 else frame
    assert cycle(exchange, read) <= wire_time(read) + 4e-3
    assert np.flatnonzero(~read.valid).tolist() == [3]
    assert exchange.errors == {"resynchronised": 1, "corrupt": 1}


def test_noise_before_the_answer_costs_nobody(read: BlockRead) -> None:
    serial, port = fake_port(IDS)
    exchange = exchange_of(serial, port)
    serial.spoil = lambda id, frame: b"\x00\xff\x37" + frame if id == 1 else frame
    cycle(exchange, read)
    assert read.valid.all()


def test_a_late_reply_is_not_taken_for_the_next_answer(read: BlockRead) -> None:
    serial, port = fake_port(IDS)
    exchange = exchange_of(serial, port)
    stale = protocol2.status(3, bytes([9] * 10))
    now = serial.clock.time
    serial.arrivals = [(now, byte) for byte in stale]
    cycle(exchange, read)
    assert read.params(2) != bytes([9] * 10)
    assert exchange.errors == {}


@pytest.mark.parametrize("missed", [4, 8])
def test_servos_that_are_back_beside_a_dead_one_are_believed_behind_a_silence(
    read: BlockRead, missed: int
) -> None:
    # Without all of them, their answers may still be those to an earlier request.
    serial, port = fake_port(IDS)
    exchange = exchange_of(serial, port)
    serial.silent |= set(IDS)
    for _ in range(missed):
        cycle(exchange, read)
    serial.silent = {20}
    for _ in range(MAX_DOUBTED):
        cycle(exchange, read)
        assert not read.valid.any()
    assert LATE_ANSWER_TIME < cycle(exchange, read) < 2 * LATE_ANSWER_TIME
    assert read.valid[:19].all()


def test_a_doubt_ends_with_the_first_whole_answer(read: BlockRead) -> None:
    serial, port = fake_port(IDS)
    exchange = exchange_of(serial, port)
    serial.silent |= set(IDS)
    for _ in range(4):
        cycle(exchange, read)
    serial.silent = {20}
    cycle(exchange, read)
    assert read.doubted
    serial.silent.clear()
    cycles = [cycle(exchange, read) for _ in range(4 * MAX_DOUBTED)]
    assert cycles[1:] == pytest.approx([wire_time(read)] * (len(cycles) - 1))


def test_servos_that_are_all_back_are_believed_at_once(read: BlockRead) -> None:
    serial, port = fake_port(IDS)
    exchange = exchange_of(serial, port)
    serial.silent |= set(IDS)
    for _ in range(8):
        cycle(exchange, read)
    serial.silent.clear()
    cycle(exchange, read)
    assert read.valid.all()


def test_a_request_behind_a_long_write_has_its_deadline_moved(read: BlockRead) -> None:
    serial, port = fake_port(IDS)
    exchange = exchange_of(serial, port)
    serial.silent.add(20)
    exchange.send([bytes(2000)])
    assert cycle(exchange, read) > 2000 * 10.0 / 1e6 + wire_time(read) - 21 * 10.0 / 1e6


def test_collecting_without_a_request_returns_nobody(read: BlockRead) -> None:
    serial, port = fake_port(IDS)
    assert exchange_of(serial, port).collect().size == 0


def test_two_buses_in_one_world_carry_their_bytes_side_by_side() -> None:
    one, port_one = fake_port(IDS)
    other, port_other = fake_port(IDS, one.clock)
    reads = [BlockRead([Span(id, 126, 10) for id in IDS]) for _ in range(2)]
    exchanges = [exchange_of(one, port_one), exchange_of(other, port_other)]
    start = one.clock.now()
    for exchange, read in zip(exchanges, reads, strict=True):
        exchange.request(read)
    for exchange in exchanges:
        assert exchange.collect().all()
    assert one.clock.now() - start == pytest.approx(wire_time(reads[0]))


def test_a_question_to_some_does_not_forget_what_the_others_owe(read: BlockRead) -> None:
    serial, port = fake_port(IDS)
    exchange = exchange_of(serial, port)
    serial.silent |= set(IDS[2:])
    cycle(exchange, read)
    few = BlockRead([Span(id, 64, 1) for id in IDS[:2]])
    serial.silent = set(IDS)
    cycle(exchange, few)
    serial.silent = {1}
    cycle(exchange, read)
    assert not read.valid.any()  # all that came may have been late
