"""The process behind `ServoPty`: serves emulated buses and executes orders of its parent.

``python -m windup.tools.testing.pty_server URL PATH``. It exchanges JSON objects, one a line: on
standard output first the paths by bus or an error, then an answer to each order that arrives on
standard input, with its number. It ends with standard input, and therefore with its parent.
"""

import json
import sys
from pathlib import Path
from threading import Thread
from typing import Any

from windup.hal.errors import WindupError
from windup.sim_twin.wire import parse_address
from windup.sim_twin.wire.serve.emulate import Emulator, emulate


def main(url: str, path: str) -> None:
    """Serve until standard input ends."""
    try:
        emulate(parse_address(url), pty=Path(path), on_ready=_begin)
    except WindupError as error:
        _tell({"error": str(error)})


def _begin(emulator: Emulator) -> None:
    """Report the paths, and start the thread that executes orders."""
    _tell({"paths": {outlet.bus.name: outlet.name for outlet in emulator.outlets}})
    Thread(target=_listen, args=(emulator,), daemon=True).start()


def _listen(emulator: Emulator) -> None:
    """Execute orders until standard input ends, then stop the emulator."""
    for line in sys.stdin:
        order = json.loads(line)
        try:
            answer = _obey(emulator, order)
        except WindupError as error:
            answer = {"error": str(error)}
        _tell(answer | {"number": order["number"]})
    emulator.stop()


def _obey(emulator: Emulator, order: dict[str, Any]) -> dict[str, Any]:
    """Execute an order and return the answer."""
    if "inject" in order:
        emulator.inject(order["inject"])
    elif "clear" in order:
        emulator.clear_faults()
    return {"driven": sum(device.driving for device in emulator.world.devices)}


def _tell(answer: dict[str, Any]) -> None:
    print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
