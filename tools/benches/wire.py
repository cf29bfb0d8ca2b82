"""Compares the duration of a bus cycle with that of its bytes, and its cost with other packages."""

import multiprocessing
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection
from pathlib import Path
from statistics import median
from typing import Any, Literal

import numpy as np

import windup.sim_twin.wire  # noqa: F401 - registers twin://
from windup.hal.bus.transactions import TURNAROUND, BusTransactions
from windup.hal.errors import WindupError
from windup.hal.port.open_port import open_port
from windup.hal.protocols.batched import BlockRead, BlockWrite
from windup.hal.protocols.cyclic import CyclicRead, CyclicWrite
from windup.hal.protocols.protocol2 import Span
from windup.tools.benches.bus import GOAL, SIZE, STATE, bench_memory, bench_pty, wire_bytes
from windup.tools.benches.bus1 import MAKERS, Vendor

BenchFamily = Literal[Vendor, "dynamixel2"]

SERVOS = 20
ROUNDS = 20
CYCLES = 25
MODEL = "XM430-W350"
BAUDS = 1_000_000, 4_000_000
WARM_UP = 5  # number of complete cycles before measuring
PATIENCE = 5.0  # s; a busy machine may delay the emulator
BITS = 10  # per byte on the wire: one start, eight data, one stop


def measure_bus(maker: BenchFamily = "dynamixel2") -> dict[str, Any]:
    """Return the processor time of a cycle relative to other packages, and its time to the wire's.

    Args:
        maker: The maker of the bench's 20 servos, and the protocol.
    """
    vendor = None if maker == "dynamixel2" else maker
    memory, over_pty = bench_memory(vendor=vendor), bench_pty(vendor=vendor)
    result: dict[str, Any] = {
        "codec_over_sdk": round(memory["codec"] / memory["sdk"], 3),
        "codec_over_sdk_pty": round(over_pty["codec"] / over_pty["sdk"], 3),
        "backend_over_sdk": round(memory["backend"] / memory["sdk"], 3),
        "backend_over_sdk_pty": round(over_pty["backend"] / over_pty["sdk"], 3),
    }
    if "rustypot" in over_pty:
        result["codec_over_rustypot"] = round(over_pty["codec"] / over_pty["rustypot"], 3)
    for baud in BAUDS if vendor is None else BAUDS[:1]:  # others support 1 Mbaud at most
        result[f"cycle_over_wire_{baud // 1_000_000}_Mbaud"] = round(
            cycle_over_wire(baud, maker), 3
        )
    if vendor is None:
        others, extra = one_missing()
        result["one_missing_others_valid"] = others
        result["one_missing_extra_ms"] = round(extra, 3)
    return result


def cycle_over_wire(
    baud: int, maker: BenchFamily, servos: int = SERVOS, rounds: int = ROUNDS, cycles: int = CYCLES
) -> float:
    """Return the median time of a cycle, as a ratio to the time of its bytes at `baud`.

    Raises:
        WindupError: The servos do not answer.
    """
    ids = list(range(1, servos + 1))
    vendor = None if maker == "dynamixel2" else maker
    model = MODEL if vendor is None else MAKERS[vendor].model
    with _emulator(model, servos, baud) as path, open_port(path, baud) as port:
        exchange = BusTransactions(port)
        read, write = _frames(ids, vendor)
        write.values[:] = np.full(servos, 2048)

        def cycle() -> bool:
            exchange.request(read)
            answered = exchange.collect()
            exchange.send(write.frames())
            return bool(answered.all())

        patience = time.perf_counter() + PATIENCE
        whole = 0
        while whole < WARM_UP:
            whole += cycle()
            if time.perf_counter() > patience:
                raise WindupError(f"the emulated {model} do not answer")
        laps = []
        for _ in range(rounds):
            began = time.perf_counter()
            for _ in range(cycles):
                cycle()
            laps.append((time.perf_counter() - began) / cycles)
    return median(laps) / (wire_bytes(servos, vendor=vendor) * BITS / baud)


def _frames(ids: list[int], vendor: Vendor | None) -> tuple[CyclicRead, CyclicWrite]:
    """Return the read and the write request of a cycle."""
    if vendor is None:
        return BlockRead([Span(id, STATE, SIZE) for id in ids]), BlockWrite(ids, GOAL, 4)
    family = MAKERS[vendor].family
    read = family.protocol.read([family.state.span(id) for id in ids], fast=True)
    return read, family.protocol.write(ids, family.registers["goal_position"])


def one_missing(cycles: int = 300, baud: int = 1_000_000) -> tuple[bool, float]:
    """Return whether the other 19 answered in every cycle, and the largest time over the wire, ms.

    In virtual time: it depends on the wire and the driver's deadline only, not on this machine.
    """
    gone = SERVOS // 2
    url = f"twin://bench?servos={MODEL}:1-{gone - 1},{MODEL}:{gone + 1}-{SERVOS}"
    others, longest = True, 0.0
    with open_port(f"{url}&baud={baud}&return_delay=0", baud) as port:
        exchange = BusTransactions(port)
        exchange.turnaround = TURNAROUND  # the servos' return delay is 0, as `configure` sets it
        read = BlockRead([Span(id, STATE, SIZE) for id in range(1, SERVOS + 1)])
        wire = (len(read.request) + read.length) * BITS / baud
        for _ in range(cycles):
            began = port.clock.now()
            exchange.request(read)
            others &= int(exchange.collect().sum()) == SERVOS - 1
            longest = max(longest, port.clock.now() - began - wire)
    return others, 1e3 * longest


@contextmanager
def _emulator(model: str, servos: int, baud: int) -> Iterator[str]:
    """Serve a bench of servos from a process of its own; yield the path of its pseudo-terminal."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bus"
        url = f"twin://bench?servos={model}:1-{servos}&baud={baud}&return_delay=0&clock=real"
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
    from windup.sim_twin.wire import parse_address
    from windup.sim_twin.wire.serve.emulate import emulate

    emulate(parse_address(url), pty=path, on_ready=lambda _: ready.send(True))
