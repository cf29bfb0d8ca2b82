import io
import json
from collections.abc import Iterator
from contextlib import closing
from typing import Any

import pytest
from rich.console import Console

from tests.tools.conftest import Windup
from windup.hal.bus.bus import Bus
from windup.hal.families import DYNAMIXEL_1, DYNAMIXEL_X, FAMILIES, FEETECH_STS
from windup.hal.port.open_port import open_port
from windup.hal.port.port import Port
from windup.hal.protocols import protocol1, protocol2
from windup.tools.bringup.scan_text import narrow_lines, problems_found, table
from windup.tools.bringup.survey import Survey, scan_targets

BAUD = 1_000_000
Answer = Any


class Clock:
    """A clock that goes on by being looked at."""

    time = 0.0

    def now(self) -> float:
        self.time += 1e-3
        return self.time

    def wait_until(self, time: float) -> None:
        self.time = max(self.time, time)


class Line:
    """A line on which `answer` says what comes back for a request, at every baud rate."""

    def __init__(self, answer: Answer) -> None:
        self.answer, self.baudrate = answer, BAUD
        self.timeout: float | None = None
        self.clock = Clock()
        self._input = b""

    def read(self, size: int = 1) -> bytes:
        data, self._input = self._input[:size], self._input[size:]
        return data

    def write(self, data: bytes) -> int:
        self._input += self.answer(data)
        return len(data)

    def reset_input_buffer(self) -> None:
        self._input = b""

    def close(self) -> None: ...


def port_of(answer: Answer) -> Port:
    return Port(Line(answer), "line")


def survey(answer: Answer, baud: int | None = BAUD, *, bridge: bool = False) -> Survey:
    port = port_of(answer)
    port.has_baud = not bridge
    found = Survey(port, {})
    found.update(baud, lambda _: None)
    return found


def said(found: Survey, missing: tuple[str, ...] = ()) -> str:
    return " | ".join(problems_found(found, "URL", list(missing)))


def clone(request: bytes) -> bytes:
    """One parameter more than the answer to a ping has."""
    asked = request in (protocol2.ping(), protocol2.ping(1))
    return protocol2.status(1, bytes([0xB0, 4, 53, 7])) if asked else b""


def foreign(request: bytes) -> bytes:
    """A Feetech servo with model number 784."""
    memory = {0: b"\x03\x0a", 3: b"\x10\x03"}
    if request[:2] != protocol1.HEADER or request[2] != 1:
        return b""
    if request[4] == protocol1.Instruction.PING:
        return protocol1.status(1)
    address, size = request[5], request[6]
    data = b"".join(memory.get(at, b"") for at in (0, 3)).ljust(8, b"\x00")
    place = {0: data[:2], 1: data[1:2], 2: b"\x00", 3: data[2:4]}.get(address, b"\x00" * size)
    return protocol1.status(1, place[:size].ljust(size, b"\x00"))


def test_silence_asks_for_the_power() -> None:
    assert said(survey(lambda _: b"")).startswith("no servo answers on URL: is the servo power on")


def test_an_answer_that_is_none_is_no_silence() -> None:
    found = survey(clone)
    assert found.servos == []
    assert said(found) == (
        "something answers on URL with frames that no supported servo sends "
        "(first bytes ff ff fd 00 01 08 00 55 ..)"
    )


def test_an_unknown_model_is_called_by_its_number() -> None:
    found = survey(foreign)
    assert "id 1 at 1000000 baud: unknown model " in said(found)
    assert "784 (Feetech STS)" in said(found)
    assert "no servo answers" not in said(found)


def test_somebody_who_talks_unasked_is_heard() -> None:
    class Chatter(Line):
        def read(self, size: int = 1) -> bytes:
            return b"\xaa\xaa\x07"[:size]

    found = Survey(Port(Chatter(lambda _: b""), "line"), {})
    found.update(4_000_000, lambda _: None)
    assert "sends (first bytes aa aa 07)" in said(found)


def test_an_x_that_speaks_protocol_1_is_told_by_its_model() -> None:
    with closing(open_port("twin://bench?servos=XM430-W350:1-2")) as port:
        register = DYNAMIXEL_X.table("XM430-W350")["protocol_type"]
        Bus(port).command(2, register, 1)
        found = Survey(port, {})
        found.update(BAUD, lambda _: None)
    assert [row["id"] for row in found.servos] == [1]
    assert (found.unknown, found.invalid) == ([], [])
    assert said(found) == (
        "id 2 at 1000000 baud: XM430-W350 uses protocol 1: "
        "set its Protocol Type (register 13) to 2 with DYNAMIXEL Wizard"
    )


def test_protocol_1_is_looked_for_at_the_baud_rates_of_the_x_series_too() -> None:
    rates = {rate for family, rate in scan_targets(port_of(lambda _: b"")) if family is DYNAMIXEL_1}
    assert rates == {*DYNAMIXEL_1.bauds, *DYNAMIXEL_X.bauds}


def test_an_echo_is_called_one_and_nothing_is_made_of_it() -> None:
    found = survey(lambda request: request)
    assert found.servos == []
    assert said(found) == "URL echoes all bytes sent: switch the echo of the adapter off"


def test_two_servos_with_one_id_are_named(shell: Windup) -> None:
    url = "twin://bench?servos=XM430-W350:1,XM430-W350:2,XM430-W350:2"
    ran = shell("scan", url, "--baud", BAUD, "--json", "-")
    assert ran.status == 3
    assert (ran.json["doubled_ids"], [row["id"] for row in ran.json["servos"]]) == ([2], [1])
    assert "id 2: only corrupt answers: are there two servos with this id?" in " ".join(
        ran.err.split()
    )


def test_behind_a_bridge_without_baud_rates_every_servo_is_one_row() -> None:
    def servo(request: bytes) -> bytes:
        if request == protocol2.ping():
            return protocol2.status(1, bytes([0xFC, 3, 45]))
        if request.startswith(protocol2.HEADER) and request[7] == protocol2.Instruction.READ:
            return protocol2.status(1, bytes(int.from_bytes(request[10:12], "little")))
        return b""

    found = survey(servo, None, bridge=True)
    assert [(row["id"], row["baud"]) for row in found.servos] == [(1, None)]
    assert [family for family, _ in scan_targets(found.port)] == list(FAMILIES)


def test_every_baud_rate_is_a_step_of_the_progress() -> None:
    steps: list[str] = []
    port = port_of(lambda _: b"")
    Survey(port, {}).update(None, steps.append)
    assert len(steps) == len(list(scan_targets(port))) > 10
    assert steps[0] == f"{DYNAMIXEL_X.name}, {next(iter(DYNAMIXEL_X.bauds))} baud"
    assert port.baud == BAUD


def test_the_board_of_op3_has_its_name(shell: Windup) -> None:
    ran = shell("scan", "twin://op3", "--baud", 2 * BAUD, "--robot", "op3", "--json", "-")
    assert ran.status == 0
    (board,) = [row for row in ran.json["servos"] if row["id"] == 200]
    assert (board["model"], board["voltage_v"], board["error"]) == ("OpenCR", 12.0, "")


@pytest.fixture
def rows(shell: Windup) -> Iterator[list[dict[str, Any]]]:
    url = "twin://bench?servos=XM430-W350:1-3"
    found = shell("scan", url, "--baud", BAUD, "--json", "-")
    assert json.loads(found.out)["servos"]
    yield [row | {"joint": "l_sho_pitch"} for row in found.json["servos"]]


@pytest.mark.parametrize("width", [40, 60, 80])
def test_the_table_fits_the_terminal(rows: list[dict[str, Any]], width: int) -> None:
    rows[1]["error"] = "overheating"
    console = Console(width=width, record=True, file=io.StringIO())
    for line in narrow_lines(rows, width):
        console.print(line)
    console.print(table(rows, width))
    text = console.export_text()
    assert max(map(len, text.splitlines())) <= width
    for word in ("XM430-W350", "l_sho_pitch", "overheating", "1000000"):
        assert word in text


def test_a_feetech_servo_is_no_unknown_dynamixel(shell: Windup) -> None:
    ran = shell("scan", "twin://bench?servos=STS3215:1-2", "--baud", BAUD, "--json", "-")
    assert (ran.status, ran.json["unknown"], len(ran.json["servos"])) == (0, [], 2)
    assert ran.json["servos"][0]["model"] in FEETECH_STS.numbers.values()
