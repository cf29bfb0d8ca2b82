"""Traces: recorded, checked against, answered from."""

from pathlib import Path

import pytest

from windup.sim_twin.wire.protocols.frames1 import encode
from windup.sim_twin.wire.serve.trace import HEADER, TraceError, read_trace
from windup.tools.testing.servo_bus import ServoBus

SERVOS = "STS3215:1-3"
READ = encode(254, 0x82, bytes((56, 6, 1, 2, 3)))


def talk(bus: ServoBus, goal: int = 2100, reads: int = 20) -> list[bytes]:
    with bus.serial() as port:
        port.write(encode(1, 3, bytes((42, goal & 255, goal >> 8))))
        port.read(6)
        got = []
        for _ in range(reads):
            port.write(READ)
            got.append(port.read(36))
            port.clock.wait_until(port.clock.now() + 0.005)
        return got


@pytest.fixture
def trace(tmp_path: Path) -> Path:
    path = tmp_path / "talk.trace"
    with ServoBus("bench", servos=SERVOS) as bus:
        bus.record(path)
        talk(bus)
    return path


def test_a_trace_has_every_byte_with_direction_and_time(trace: Path) -> None:
    lines = read_trace(trace)
    assert [line.direction for line in lines] == [">", "<"] * 21
    assert lines[0].data == encode(1, 3, bytes((42, 0x34, 8)))
    assert lines[1].data == encode(1, 0)
    assert lines[1].time == pytest.approx(lines[0].time + len(lines[0].data) * 1e-5)
    text = trace.read_text()
    assert text.startswith(HEADER) and "bench > 1000000 - ff ff 01 05 03 2a" in text


def test_the_same_again_is_no_difference(trace: Path) -> None:
    with ServoBus("bench", servos=SERVOS) as bus:
        bus.check(trace)
        talk(bus)


def test_the_first_byte_that_differs_is_shown(trace: Path) -> None:
    bus = ServoBus("bench", servos=SERVOS)
    bus.check(trace)
    with pytest.raises(TraceError) as caught:
        talk(bus, goal=2101)
        bus.close()
    text = str(caught.value)
    assert f"{trace}, line 2: byte 6 of 9 differs" in text
    wanted, got, mark = text.splitlines()[-3:]
    assert wanted.startswith("- 0.000000000 bench > 1000000 - ff ff 01 05 03 2a 34 08")
    assert got.startswith("+ 0.000000000 bench > 1000000 - ff ff 01 05 03 2a 35 08")
    assert wanted[mark.index("^^") :].startswith("34")


def test_less_than_recorded_is_a_difference_too(trace: Path) -> None:
    bus = ServoBus("bench", servos=SERVOS)
    bus.check(trace)
    talk(bus, reads=19)
    with pytest.raises(TraceError, match="no further bytes"):
        bus.close()


def test_a_bus_answers_from_a_trace(trace: Path) -> None:
    with ServoBus("bench", servos=SERVOS) as bus:
        wanted = talk(bus)
    with ServoBus.replay(trace) as bus:
        assert talk(bus) == wanted


def test_a_host_that_sends_something_else_is_told_so(trace: Path) -> None:
    bus = ServoBus.replay(trace)
    with pytest.raises(TraceError, match="line 2: byte 6 of 9 differs"):
        talk(bus, goal=2101)
    with pytest.raises(TraceError):
        bus.close()


def test_a_host_that_is_late_is_told_so(trace: Path) -> None:
    bus = ServoBus.replay(trace)
    bus.wait(0.001)
    with pytest.raises(TraceError, match=r"line 2: \+1000.0 us"):
        talk(bus)
    with pytest.raises(TraceError):
        bus.close()


def test_a_trace_has_what_faults_make_of_answers(tmp_path: Path) -> None:
    path = tmp_path / "faults.trace"
    faults = "corrupt:0.1,drop:0.1,delay:0.1:seconds=0.003,glue:0.1,noise:0.1,cut:0.1"
    with ServoBus("bench", faults=faults, seed=3, servos=SERVOS) as bus:
        bus.golden(path)
        wanted = talk(bus, reads=60)
    with ServoBus.replay(path) as bus:
        assert talk(bus, reads=60) == wanted
    with ServoBus("bench", faults=faults, seed=3, servos=SERVOS) as bus:
        bus.golden(path)
        assert talk(bus, reads=60) == wanted


def test_something_else_is_no_trace(tmp_path: Path) -> None:
    (tmp_path / "x").write_text("hello")
    with pytest.raises(TraceError, match="is no trace"):
        ServoBus.replay(tmp_path / "x")
