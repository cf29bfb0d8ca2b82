"""The process behind `ServoPty`: serves emulated buses, and takes orders from its parent.

``python -m windup.tools.testing.pty_server URL PATH``. One JSON object a line: on standard output
first the paths by bus, or an error; then an answer to every order on standard input. It ends with
its standard input, so it never outlives the program that has started it.
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
    """Serve until the parent closes our standard input."""
    try:
        emulate(parse_address(url), pty=Path(path), on_ready=_begin)
    except WindupError as error:
        _tell({"error": str(error)})


def _begin(emulator: Emulator) -> None:
    """Say what to open, and listen for orders from now on."""
    _tell({"paths": {outlet.bus.name: outlet.name for outlet in emulator.outlets}})
    Thread(target=_listen, args=(emulator,), daemon=True).start()


def _listen(emulator: Emulator) -> None:
    """Obey until the parent has gone."""
    for line in sys.stdin:
        try:
            _tell(_obey(emulator, json.loads(line)))
        except WindupError as error:
            _tell({"error": str(error)})
    emulator.stop()


def _obey(emulator: Emulator, order: dict[str, Any]) -> dict[str, Any]:
    """Carry out an order and return the answer."""
    if "inject" in order:
        emulator.inject(order["inject"])
    elif "clear" in order:
        emulator.clear_faults()
    return {"driven": sum(device.driving for device in emulator.world.devices)}


def _tell(answer: dict[str, Any]) -> None:
    print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
