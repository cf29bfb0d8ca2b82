"""What a full cycle of a bus takes beside the time of its bytes, and beside other packages."""

import multiprocessing
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from hal.exchange import Exchange
from hal.open_port import open_port
from hal.protocols.batched import BlockRead, BlockWrite
from hal.protocols.protocol2 import Span
from tools.bench_bus import GOAL, SIZE, STATE, bench_memory, bench_pty, wire_bytes

SERVOS = 20
ROUNDS = 20
CYCLES = 25
BITS = 10  # a byte on the wire: start, eight, stop


def measure_bus(name: str) -> dict[str, Any]:
    """Return the processor time of a cycle beside other packages', and its time over the wire's.

    Args:
        name: Ignored: the bus is a bench of 20 XM430-W350.
    """
    memory, over_pty = bench_memory(), bench_pty()
    result: dict[str, Any] = {
        "codec_over_sdk": round(memory["codec"] / memory["sdk"], 3),
        "codec_over_sdk_pty": round(over_pty["codec"] / over_pty["sdk"], 3),
        "backend_over_sdk": round(memory["backend"] / memory["sdk"], 3),
        "backend_over_sdk_pty": round(over_pty["backend"] / over_pty["sdk"], 3),
    }
    if "rustypot" in over_pty:
        result["codec_over_rustypot"] = round(over_pty["codec"] / over_pty["rustypot"], 3)
    for baud in (1_000_000, 4_000_000):
        result[f"cycle_over_wire_{baud // 1_000_000}_Mbaud"] = round(_cycle_over_wire(baud), 3)
    return result


def _cycle_over_wire(baud: int) -> float:
    """Return the median time of a cycle over the time of its bytes at `baud`."""
    ids = list(range(1, SERVOS + 1))
    with _emulator(baud) as path, open_port(path, baud) as port:
        exchange = Exchange(port)
        read = BlockRead([Span(id, STATE, SIZE) for id in ids])
        write = BlockWrite(ids, GOAL, 4)
        write.values[:] = np.full(SERVOS, 2048)

        def cycle() -> None:
            exchange.request(read)
            exchange.collect()
            exchange.send([write.frame()])

        for _ in range(CYCLES):
            cycle()
        laps = []
        for _ in range(ROUNDS):
            began = time.perf_counter()
            for _ in range(CYCLES):
                cycle()
            laps.append((time.perf_counter() - began) / CYCLES)
    return median(laps) / (wire_bytes(SERVOS) * BITS / baud)


@contextmanager
def _emulator(baud: int) -> Iterator[str]:
    """Serve a bench of servos from a process of its own; yield the path of its terminal."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bus"
        url = f"twin://bench?servos=XM430-W350:1-{SERVOS}&baud={baud}&return_delay=0&clock=real"
        process = context.Process(target=_serve, args=(url, path, theirs), daemon=True)
        process.start()
        try:
            ours.recv()
            yield str(path)
        finally:
            process.terminate()
            process.join()


def _serve(url: str, path: Path, ready: Connection) -> None:
    """Serve the world of `url` for ever."""
    from sim_twin.wire import parse_address
    from sim_twin.wire.emulate import emulate

    emulate(parse_address(url), pty=path, on_ready=lambda _: ready.send(True))
