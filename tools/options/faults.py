"""`--faults`: what goes wrong on an emulated bus, as a part of its URL."""

from urllib.parse import quote

from windup.hal.errors import UsageError
from windup.sim_twin.wire import parse_address
from windup.sim_twin.wire.faults.faults import Faults
from windup.sim_twin.wire.world.address import SCHEME


def with_faults(port: str | None, faults: str) -> str | None:
    """Return the URL of a port with `faults` on it, as in `Faults.parse`; without any, as it is.

    >>> with_faults("twin://duck?clock=virtual", "drop:0.01,dead:ids=7:at=2;3")
    'twin://duck?clock=virtual&faults=drop:0.01,dead:ids=7:at=2;3'

    Raises:
        UsageError: There is no such fault, the port is none that could have it, or has some.
    """
    if not faults:
        return port
    Faults.parse(faults)
    if port is None or not port.startswith(f"{SCHEME}://"):
        where = "no --port" if port is None else f"--port {port}"
        raise UsageError(f"--faults needs a {SCHEME}:// port, there is {where}")
    if parse_address(port).faults:
        raise UsageError(f"--faults {faults}: {port} has faults already; give them once")
    return f"{port}{'&' if '?' in port else '?'}faults={quote(faults, safe=':,;=')}"
