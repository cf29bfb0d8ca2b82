"""`open_port(url)`: opens the port that a user names, or raises an error that states the remedy."""

import contextlib
import errno
import importlib
import os
import stat
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import serial
from serial.tools import list_ports

from windup.hal.errors import PortError, UsageError
from windup.hal.port.network_port import RFC2217, NetworkPort
from windup.hal.port.port import GONE, DevicePort, Port
from windup.hal.port.port_access import access_remedy
from windup.hal.port.socket_port import RAW, Connection, SocketPort

BAUD = 1_000_000
MEMORY_DEVICES = 1
"""Major number of /dev/null, /dev/zero and similar devices (Linux, admin-guide/devices.txt)."""


def open_port(url: str, baud: int = BAUD, *, exclusive: bool = True) -> Port:
    """Open a device path, ``usb:SERIAL``, ``twin://...`` or any URL of pyserial.

    Devices are opened exclusively by default, and with low latency mode if the driver supports it.

    Raises:
        PortError: It cannot be opened; the message says what to do.
        UsageError: There is no handler for this kind of URL.
    """
    if "://" in url:
        _check_handler(url)
        opened = _open(url, url, baud, exclusive)
        if url.startswith(RAW):
            return SocketPort(opened, url)
        return NetworkPort(opened, url) if url.startswith(RFC2217) else Port(opened, url)
    device = _by_serial_number(url[4:]) if url.startswith("usb:") else url
    _check_kind(device, url)
    if exclusive:
        _check_holder(device)
    opened = _open(device, url, baud, exclusive)
    # Pseudo-terminals and some drivers do not support the call, but have no such latency either.
    with contextlib.suppress(ValueError, OSError, NotImplementedError):
        opened.set_low_latency_mode(True)
    return DevicePort(opened, url, _latency(device))


def _open(target: str, url: str, baud: int, exclusive: bool) -> Any:
    try:
        if target.startswith(RAW):
            return Connection(target, baud)
        if "://" in target:
            return serial.serial_for_url(target, baudrate=baud, timeout=0)
        return serial.Serial(target, baudrate=baud, timeout=0, exclusive=exclusive)
    except GONE as error:
        raise PortError(_explain(target, url, error)) from None
    except ValueError as error:
        raise UsageError(f"{url}: {error}") from None


def _check_handler(url: str) -> None:
    """Raise UsageError if the URL's handler is missing or fails to import; pyserial hides why."""
    scheme = url.split("://", 1)[0].lower()
    try:
        _ = urlsplit(url).port
    except ValueError as error:
        raise UsageError(f"{url}: {error}") from None
    name = f"protocol_{scheme}"
    for package in serial.protocol_handler_packages:
        module = f"{package}.{name}"
        try:
            importlib.import_module(module)
        except ModuleNotFoundError as error:
            if error.name in (module, package):
                continue
            raise UsageError(f"{url}: its handler {module} needs {error.name!r}") from error
        return
    if scheme == "twin":
        raise UsageError(
            f"{url}: twin:// is not available in this process; `import windup.sim_twin.wire` "
            "first, or use the `windup` command, which does"
        )
    raise UsageError(f"{url}: pyserial knows no {scheme}:// ports")


def _by_serial_number(number: str) -> str:
    ports = list_ports.comports()
    for port in ports:
        if port.serial_number == number:
            return str(port.device)
    known = ", ".join(sorted(p.serial_number for p in ports if p.serial_number)) or "none"
    raise PortError(f"no USB adapter with serial number {number!r}; plugged in: {known}")


def stable_url(url: str) -> str:
    """Return a URL that identifies the same adapter after it is replugged.

    That is "usb:SERIAL" for a device with a unique serial number, else `url`.
    """
    if "://" in url or url.startswith("usb:"):
        return url
    device = os.path.realpath(url)
    ports = [port for port in list_ports.comports() if port.serial_number]
    for port in ports:
        if os.path.realpath(port.device) == device:
            twins = [other for other in ports if other.serial_number == port.serial_number]
            return f"usb:{port.serial_number}" if len(twins) == 1 else url
    return url


def _explain(device: str, url: str, error: Exception) -> str:
    code = getattr(error, "errno", None)
    if "://" in device:
        return f"{url} cannot be opened: {error}"
    if not os.path.exists(device):
        return f"no port {url}; serial ports here: {_ports()}"
    if code == errno.EACCES or "ermission denied" in str(error):
        return f"no permission for {url}; {access_remedy(device)}"
    if code in (errno.EAGAIN, errno.EBUSY, errno.EWOULDBLOCK) or "lock port" in str(error):
        return _busy(url, holders(device))
    return f"port {url} cannot be opened: {error}"


def _busy(url: str, held_by: dict[int, str]) -> str:
    """Return the message that names the processes that use a port, and how to end them."""
    if os.getpid() in held_by:
        return f"port {url} is in use by this program; close that connection first"
    if not held_by:
        return f"port {url} is in use by a process of another user; end it first"
    who = ", ".join(f"{name} (pid {pid})" for pid, name in held_by.items())
    it, pids = "it" if len(held_by) == 1 else "them", " ".join(map(str, held_by))
    return f"port {url} is in use by {who}; end {it} first: Ctrl-C there, or `kill -INT {pids}`"


def _check_kind(device: str, url: str) -> None:
    """Raise PortError if a path exists but is no serial port: file, folder, disk, /dev/null."""
    with contextlib.suppress(OSError):  # missing or not accessible: opening reports it
        found = os.stat(device)
        if not stat.S_ISCHR(found.st_mode) or os.major(found.st_rdev) == MEMORY_DEVICES:
            raise PortError(f"{url} is not a serial port; serial ports here: {_ports()}")


def _ports() -> str:
    return ", ".join(sorted(p.device for p in list_ports.comports())) or "none"


def _check_holder(device: str) -> None:
    """Raise PortError if another process has a device open without a lock, as makers' tools do.

    Pseudo-terminals are exempt, because their server may hold them open; there only locks count.
    """
    real = os.path.realpath(device)
    if real.startswith("/dev/pts/") or not os.path.exists(real):
        return
    if held_by := holders(device):
        raise PortError(_busy(device, held_by))


def holders(device: str) -> dict[int, str]:
    """Map pid to name of the processes that have `device` open, as far as permissions allow."""
    real = os.path.realpath(device)
    found = {}
    with contextlib.suppress(OSError):  # too many files may be open to list /proc
        for pid in sorted(int(name) for name in os.listdir("/proc") if name.isdigit()):
            process = Path(f"/proc/{pid}")
            with contextlib.suppress(OSError):
                if any(os.path.realpath(fd) == real for fd in (process / "fd").iterdir()):
                    found[pid] = (process / "comm").read_text().strip()
    return found


def _latency(device: str) -> float | None:
    """Return the latency timer of an FTDI adapter, s; None for other devices."""
    name = os.path.basename(os.path.realpath(device))
    try:
        return int(Path(f"/sys/class/tty/{name}/device/latency_timer").read_text()) * 1e-3
    except (OSError, ValueError):
        return None
