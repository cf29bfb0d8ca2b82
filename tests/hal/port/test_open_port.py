import fcntl
import os
from collections.abc import Callable
from pathlib import Path

import pytest
import serial

from windup.hal.errors import PortError, UsageError
from windup.hal.port.open_port import _busy, holders, open_port
from windup.hal.port.port import DevicePort


@pytest.fixture
def pty() -> tuple[int, str]:
    master, slave = os.openpty()
    return master, os.ttyname(slave)


def test_a_pseudo_terminal_is_a_port(pty: tuple[int, str]) -> None:
    master, path = pty
    with open_port(path, 1_000_000) as port:
        assert isinstance(port, DevicePort)
        os.write(master, b"abc")
        assert port.read(3, port.clock.now() + 1.0) == b"abc"
        port.write(b"hello")
        assert os.read(master, 5) == b"hello"
        port.baud = 57_600
        assert (port.baud, port.sent, port.received) == (57_600, 5, 3)
        os.write(master, b"late")
        port.flush_input()
        assert port.read(1, port.clock.now()) == b""


@pytest.mark.parametrize("doing", ["read", "write", "flush_input"])
def test_a_port_that_is_pulled_out_is_an_error_whatever_is_going_on(
    pty: tuple[int, str], doing: str
) -> None:
    master, path = pty
    port = open_port(path)
    calls: dict[str, Callable[[], object]] = {
        "read": lambda: port.read(1, port.clock.now() + 0.1),
        "write": lambda: port.write(b"x"),
        "flush_input": port.flush_input,
    }
    os.close(master)
    with pytest.raises(PortError, match="was disconnected"):
        calls[doing]()
    port.close()


def test_a_port_that_this_program_has_is_not_another_ones(pty: tuple[int, str]) -> None:
    _, path = pty
    held = os.open(path, os.O_RDWR)
    fcntl.flock(held, fcntl.LOCK_EX)
    name = Path("/proc/self/comm").read_text().strip()
    with pytest.raises(PortError, match=f"port {path} is in use by this program; close"):
        open_port(path)
    assert holders(path)[os.getpid()] == name
    os.close(held)


def test_a_port_in_use_names_its_holder_and_how_to_end_it() -> None:
    said = _busy("/dev/ttyUSB0", {7: "windup"})
    assert said == (
        "port /dev/ttyUSB0 is in use by windup (pid 7); end it first: Ctrl-C there, "
        "or `kill -INT 7`"
    )
    both = _busy("/dev/ttyUSB0", {7: "windup", 9: "python"})
    assert "by windup (pid 7), python (pid 9); end them first" in both
    assert both.endswith("`kill -INT 7 9`")


def test_a_port_is_found_from_every_working_folder(
    pty: tuple[int, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "bus").symlink_to(pty[1])
    monkeypatch.chdir(tmp_path)
    with open_port("bus") as port:
        monkeypatch.chdir("/")
        assert (port.url, port.absolute_url) == ("bus", str(tmp_path / "bus"))


def test_a_port_whose_number_select_does_not_take_is_read_all_the_same(
    pty: tuple[int, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    master, path = pty
    monkeypatch.setattr("windup.hal.port.port.SELECTABLE", 0)
    monkeypatch.setattr("select.select", None)
    with open_port(path) as port:
        assert port.read(3, port.clock.now()) == b""
        os.write(master, b"abc")
        assert port.read(3, port.clock.now() + 1.0) == b"abc"
        port.write(b"hello")
    assert os.read(master, 5) == b"hello"


def test_a_port_that_is_not_there_lists_those_that_are() -> None:
    with pytest.raises(PortError, match=r"no port /dev/ttyNONE; serial ports here: "):
        open_port("/dev/ttyNONE")


def test_permission_denied_says_what_would_help(
    pty: tuple[int, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise serial.SerialException(13, "could not open port: Permission denied")

    monkeypatch.setattr(serial, "Serial", refuse)
    remedy = "windup.hal.port.open_port.access_remedy"
    monkeypatch.setattr(remedy, lambda device: f"ask for {device}")
    with pytest.raises(PortError, match=rf"no permission for {pty[1]}; ask for {pty[1]}"):
        open_port(pty[1])


def test_an_unknown_usb_serial_number_is_named() -> None:
    with pytest.raises(PortError, match="no USB adapter with serial number 'NOPE'"):
        open_port("usb:NOPE")


def test_a_twin_without_its_handler_says_what_to_import(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(serial, "protocol_handler_packages", ["serial.urlhandler"])
    with pytest.raises(UsageError, match=r"`import windup.sim_twin.wire` first"):
        open_port("twin://op3")


def test_an_unknown_kind_of_url_is_refused() -> None:
    with pytest.raises(UsageError, match="pyserial knows no carrier:// ports"):
        open_port("carrier://pigeon")


def test_an_unplugged_device_is_one_error(pty: tuple[int, str]) -> None:
    master, path = pty
    port = open_port(path)
    os.close(master)
    with pytest.raises(PortError, match=r"was disconnected .*; check cable and power"):
        port.read(1, port.clock.now() + 1.0)
    port.close()


def test_any_url_of_pyserial_is_a_port() -> None:
    with open_port("loop://") as port:
        port.write(b"round")
        assert port.read(5, port.clock.now() + 1.0) == b"round"


@pytest.mark.parametrize("path", ["/dev/null", "/dev/zero", __file__, "/"])
def test_what_is_no_serial_port_is_told_so(path: str) -> None:
    with pytest.raises(PortError, match=f"^{path} is not a serial port; serial ports here: "):
        open_port(path)
