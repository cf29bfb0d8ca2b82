"""An adapter's latency and echo are found out, and neither ever makes a wrong value."""

import pytest

from tests.hal.adapters import ONE_OF_EACH, Adapter, adapter_port
from windup.hal.bus.bus import Bus
from windup.hal.errors import NoAnswerError

IDS = [1, 2, 3]

makers = pytest.mark.parametrize("maker", ONE_OF_EACH)


def on_bus(maker: str, held: float = 0.0, echoes: bool = False) -> tuple[Adapter, Bus]:
    serial, port, family = adapter_port(maker, *IDS)
    serial.held, serial.echoes = held, echoes
    return serial, Bus(port, family)


def values(bus: Bus) -> list[int]:
    """Set goals one by one, read them alone and together, and return what came."""
    goal = bus.family.registers["goal_position"]
    for id in IDS:
        bus.write(id, goal, 500 + id)
    bus.sync_write(goal, {id: 510 + id for id in IDS})
    counts, valid = bus.sync_read(IDS, goal)
    assert valid.all()
    return [*(bus.read(id, goal) for id in IDS), *counts]


@makers
def test_a_latency_that_nobody_tells_is_measured(maker: str) -> None:
    _, bus = on_bus(maker, held=16e-3)
    bus.measure_adapter(IDS)
    assert 16e-3 <= bus.port.latency <= 25e-3
    assert values(bus) == [511, 512, 513] * 2
    assert not bus.port.echoes


@makers
def test_an_adapter_that_holds_nothing_back_stays_as_it_was_said_to_be(maker: str) -> None:
    _, bus = on_bus(maker)
    bus.measure_adapter(IDS)
    assert bus.port.latency == 1e-3


@makers
def test_what_an_adapter_gives_back_is_never_read(maker: str) -> None:
    _, bus = on_bus(maker, echoes=True)
    bus.measure_adapter(IDS)
    assert bus.port.echoes
    assert values(bus) == [511, 512, 513] * 2
    assert bus.exchange.errors == {}


@makers
def test_an_echo_is_found_where_nobody_answers_and_the_latency_is_left(maker: str) -> None:
    serial, bus = on_bus(maker, echoes=True)
    serial.silent.update(IDS)
    bus.measure_adapter(IDS)
    assert bus.port.echoes and bus.port.latency == 1e-3
    with pytest.raises(NoAnswerError):
        bus.ping(1)


@makers
def test_an_echo_that_nobody_has_found_is_no_answer(maker: str) -> None:
    serial, bus = on_bus(maker, echoes=True)
    assert values(bus) == [511, 512, 513] * 2
    serial.silent.update(IDS)
    for id in IDS:
        with pytest.raises(NoAnswerError):
            bus.read(id, bus.family.registers["model_number"])
    assert not bus.sync_read(IDS, bus.family.registers["model_number"])[1].any()


@makers
def test_an_answer_that_is_always_late_is_none_and_never_another_ones(maker: str) -> None:
    serial, bus = on_bus(maker)
    goal, number = (bus.family.registers[name] for name in ("goal_position", "model_number"))
    bus.write(1, goal, 700)
    serial.held = 16e-3
    for register in (goal, number, goal):
        with pytest.raises(NoAnswerError):
            bus.read(1, register)
    serial.held = 0.0
    assert bus.read(1, goal) == 700


@makers
@pytest.mark.parametrize("held", [11e-3, 13e-3, 16e-3, 20e-3, 30e-3])
def test_one_late_answer_is_not_taken_for_the_next(
    maker: str, held: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    serial, bus = on_bus(maker)
    goal, number = (bus.family.registers[name] for name in ("goal_position", "model_number"))
    wanted = bus.read(1, number)
    bus.write(1, goal, 700)
    write = serial.write

    def once(data: bytes) -> int:
        serial.held = held
        sent = write(data)
        serial.held = 0.0
        monkeypatch.undo()
        return sent

    monkeypatch.setattr(serial, "write", once)
    assert bus.read(1, number) == wanted
    bus.write(1, goal, 701)
    assert bus.read(1, goal) == 701


def test_a_port_that_is_back_is_known_already() -> None:
    _, bus = on_bus("STS", held=16e-3, echoes=True)
    bus.measure_adapter(IDS)
    again, port, _ = adapter_port("STS", *IDS)
    again.held, again.echoes = 16e-3, True
    bus.move_to(port)
    assert values(bus) == [511, 512, 513] * 2


def test_one_request_that_comes_back_makes_no_echoing_adapter(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    serial, bus = on_bus("STS", echoes=True)
    write = serial.write

    def once(data: bytes) -> int:
        sent = write(data)
        serial.echoes = False
        return sent

    monkeypatch.setattr(serial, "write", once)
    bus.measure_adapter(IDS)
    assert not bus.port.echoes


@makers
def test_a_scan_finds_servos_behind_an_adapter_that_is_late(maker: str) -> None:
    serial, port, family = adapter_port(maker, 17, 18)
    serial.held = 16e-3
    assert [found.id for found in Bus(port, family).scan([1_000_000])] == [17, 18]


@makers
def test_a_scan_finds_servos_behind_an_adapter_that_gives_back(maker: str) -> None:
    serial, port, family = adapter_port(maker, 17, 18)
    serial.echoes = True
    assert [found.id for found in Bus(port, family).scan([1_000_000])] == [17, 18]
