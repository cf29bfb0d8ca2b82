"""Every call of rustypot's controllers on the emulated servos that they are for, in real time."""

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import rustypot

from tests.sim_twin.wire.emulator_process import emulator

SERVOS = {
    "Sts3215": ("STS3215:1-2", 777),
    "Scs0009": ("SCS0009:1-2&supply=6", 1284),
    "Mx": ("MX-106:1-2", 320),
    "Ax": ("AX-12A:1-2", 12),
    "Xl330": ("XL330-M288:1-2&supply=5", 1200),
    "Xl430": ("XM430-W350:1-2", 1020),
}
ABSENT = {"Xl330": {"acceleration_limit", "indirect_data_5", "indirect_data_6"}}
"""Registers that rustypot has and the manual has not; rustypot panics when they are refused."""
FIXED = {
    "Scs0009": {"pwm_maximum_step", "moving_velocity_threshold", "dts", "minimum_velocity_limit",
                "maximum_velocity_limit"},  # the memory table calls them the factory's
    "Xl330": {"firmware_version", "registered_instruction", "hardware_error_status"},  # read-only
}  # fmt: skip
NOT_CHANGED = {"id", "baudrate", "baud_rate", "protocol_type", "lock", "status_return_level",
               "response_status_level"}  # fmt: skip
"""Written as they are: with another value, rustypot would not hear of the servo any more."""
IDS = [1, 2]
PATIENCE = 4.0  # s, for a busy machine


class Pot:
    """A controller, and which of its calls have been made."""

    def __init__(self, name: str, path: str) -> None:
        self.name, self.model = name, SERVOS[name][1]
        self.kind = getattr(rustypot, f"{name}PyController")
        self.controller = self.kind(path, 1_000_000, PATIENCE)
        self.called: set[str] = set()
        self("supports_sync_read")
        self.syncs = name not in ("Ax", "Mx")  # rustypot asks, but their protocol has none

    def __call__(self, call: str, *arguments: Any) -> Any:
        self.called.add(call)
        return getattr(self.controller, call)(*arguments)

    def registers(self) -> list[Any]:
        absent = ABSENT.get(self.name, set())
        return [one for one in self("registers") if one.name not in absent]

    def raws(self, name: str) -> list[str]:
        """Return the register's name, and its name without a unit where it has one."""
        return [name, *([f"raw_{name}"] if hasattr(self.kind, f"read_raw_{name}") else [])]


@pytest.fixture(scope="module", params=SERVOS)
def pot(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> Iterator[Pot]:
    path: Path = tmp_path_factory.mktemp("rustypot") / "servos"
    with emulator(f"twin://bench?servos={SERVOS[request.param][0]}&return_delay=0", path) as name:
        made = Pot(request.param, name)
        yield made


def test_it_makes_every_call(pot: Pot) -> None:
    check_discovery(pot)
    for register in pot.registers():
        check_reads(pot, register)
        if "Write" in str(register.access):
            check_writes(pot, register.name)
            rewrite(pot, register)
    check_resets(pot)
    public = {call for call in dir(pot.kind) if not call.startswith("_")}
    absent = tuple(ABSENT.get(pot.name, set()))
    left = {call for call in public - pot.called if not call.endswith(absent)}
    assert left == {call for call in public if call.startswith("sync_read") and not pot.syncs}


def check_discovery(pot: Pot) -> None:
    everybody = dict.fromkeys(IDS, pot.model)
    wait_for(lambda: pot("scan", IDS) == everybody)  # it does not wait as long as it is told to
    if pot("supports_broadcast_ping"):
        wait_for(lambda: pot("broadcast_scan", IDS) == everybody)
    else:
        with pytest.raises(ValueError, match="does not answer a broadcast ping"):
            pot("broadcast_scan", IDS)
    assert pot("ping", 1)
    pot("set_timeout", 0.05)
    assert not pot("ping", 9)
    pot("set_timeout", PATIENCE)
    assert pot("is_open")
    assert (1_000_000 in pot("baudrates")) is (pot.name not in ("Ax", "Mx"))  # it knows none
    assert pot.model in pot("models").values()
    assert pot("word_order") == ("big" if pot.name == "Scs0009" else "little")
    assert pot("resolution") in (1024, 4096)
    assert pot("definition") is not None
    assert pot("register", pot.registers()[0].name).addr == 0
    if hasattr(pot.kind, "set_fast_sync_read"):
        pot("set_fast_sync_read", True)


def check_reads(pot: Pot, register: Any) -> None:
    """Read a register in all ways; what does not live is the same in all of them."""
    name, place = register.name, (register.addr, register.size)
    value = pot("read_register", 1, name)
    _, error = pot("read_register_with_error", 1, name)
    data, error2 = pot("read_raw_data_with_error", 1, *place)
    assert (error, error2, len(data)) == (0, 0, register.size)
    assert len(pot("read_raw_data", 1, *place)) == register.size
    one = [pot(f"read_{named}", 1) for named in pot.raws(name)]
    if pot.syncs:
        both = [pot(f"sync_read_{named}", IDS) for named in pot.raws(name)]
        assert [len(values) for values in both] == [2] * len(one)
        assert len(pot("sync_read_register", IDS, name)) == 2
        assert [e for _, e in pot("sync_read_register_with_error", IDS, name)] == [0, 0]
        assert [len(raw) for raw in pot("sync_read_raw_data", IDS, *place)] == [register.size] * 2
        assert [e for _, e in pot("sync_read_raw_data_with_error", IDS, *place)] == [0, 0]
        if "Write" in str(register.access):
            assert [values[0] for values in both] == [values[0] for values in one]
    if "Write" in str(register.access):
        assert pot("read_register", 1, name) == value


def check_writes(pot: Pot, name: str) -> None:
    """Change a register by one count and back."""
    if name in NOT_CHANGED:
        return
    before = pot("read_register", 1, name)
    fixed = name in FIXED.get(pot.name, set())
    taken = [value for value in (before + 1, before - 1) if takes(pot, name, value)]
    assert bool(taken) is not fixed, name
    pot("write_register", 1, name, before) if not fixed else None
    assert pot("read_register", 1, name) == before


def takes(pot: Pot, name: str, value: int) -> bool:
    """Whether a register takes a value: not those that do not fit, or are refused."""
    try:
        pot("write_register_with_error", 1, name, value)
    except ValueError:
        return False
    return bool(pot("read_register", 1, name) == value)


def rewrite(pot: Pot, register: Any) -> None:
    """Write what is there in all other ways."""
    name, before = register.name, pot("read_register", 1, register.name)
    for named in pot.raws(name):
        (value,) = pot(f"read_{named}", 1)
        pot(f"write_{named}", 1, value)
        pot(f"sync_write_{named}", [1], [value])
    data = pot("read_raw_data", 1, register.addr, register.size)
    pot("write_raw_data", 1, register.addr, data)
    refused = pot("write_raw_data_with_error", 1, register.addr, data)
    assert not refused or name in FIXED.get(pot.name, ())
    pot("sync_write_raw_data", [1], register.addr, [data])
    pot("sync_write_register", [1], name, [before])
    assert pot("read_register", 1, name) == before


def check_resets(pot: Pot) -> None:
    pot("set_baudrate", 57_600)
    pot("set_timeout", 0.05)
    assert not pot("ping", 1)
    pot("set_timeout", 0.3)
    pot("set_baudrate", 1_000_000)
    pot("reboot", 2)
    wait_for(lambda: pot("ping", 2))
    pot("set_timeout", PATIENCE)
    assert pot("read_register", 2, "return_delay_time") == 0
    if pot.name.startswith("Xl"):
        pot("factory_reset", 2)
        pot("set_timeout", 0.3)
        wait_for(lambda: pot("ping", 2))
        assert pot("read_register", 2, "return_delay_time") == 250
    else:
        with pytest.raises(RuntimeError, match="not supported"):  # by rustypot, in protocol 1
            pot("factory_reset", 2)
    pot("close")
    assert not pot("is_open")


def wait_for(what: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 30.0
    while not what():
        assert time.monotonic() < deadline
