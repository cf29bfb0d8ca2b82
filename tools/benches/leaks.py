"""Measures what remains after opening a robot, running it briefly and closing it, many times."""

import gc
import multiprocessing
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Final

from rich.console import Console
from rich.progress import Progress

from windup.hal.telemetry.runtime_folder import runtime_folder
from windup.robots import load_robot
from windup.sim_twin.wire import parse_address
from windup.sim_twin.wire.serve.emulate import emulate
from windup.tools.benches.safety.emulated import port_of
from windup.tools.robot.robot import Robot
from windup.tools.terminal.output import console

RUN: Final = 0.1
"""Time for which the robot stands each time, s."""
WARM: Final = 0.1
"""Share of the repetitions before the reference: by then all caches are filled."""
SLOW: Final = 20
"""Factor by which there are fewer repetitions on a pseudo-terminal, in real time."""
MEMORY_LIMIT: Final = 5.0
"""Allowed growth of memory, MB."""
COUNTED: Final = ("descriptors", "threads", "processes", "files")
"""Resources of which there may be no more than before."""


@dataclass(frozen=True)
class Resources:
    """Resources of this process.

    Attributes:
        memory: Resident memory, MB.
        descriptors: Number of open files, pipes and ports.
        threads: Number of threads.
        processes: Number of child processes.
        files: Number of files in the user's runtime folder.
    """

    memory: float
    descriptors: int
    threads: int
    processes: int
    files: int

    @classmethod
    def now(cls) -> "Resources":
        """Collect garbage, then count the resources."""
        gc.collect()
        tasks = list(Path("/proc/self/task").iterdir())
        children = [(task / "children").read_text().split() for task in tasks]
        resident = int(Path("/proc/self/statm").read_text().split()[1])
        return cls(
            memory=resident * os.sysconf("SC_PAGE_SIZE") / 1e6,
            descriptors=len(os.listdir("/proc/self/fd")),
            threads=len(tasks),
            processes=sum(map(len, children)),
            files=len(list(runtime_folder().iterdir())),
        )

    def since(self, before: "Resources") -> dict[str, float]:
        """Return the growth since `before`."""
        counts = {name: getattr(self, name) - getattr(before, name) for name in COUNTED}
        return {"memory_grown_mb": round(self.memory - before.memory, 2), **counts}


def measure_leaks(name: str, times: int) -> dict[str, Any]:
    """Return what remains after opening a robot many times: as a twin, on `twin://`, on a port.

    Args:
        name: The robot.
        times: Number of repetitions; on a pseudo-terminal a twentieth of that.
    """
    rows = {"twin": leaks(name, None, times)}
    if any(load_robot(name).servos):
        rows["wire"] = leaks(name, f"twin://{name}", times)
        with emulated(name) as port:
            rows["port"] = leaks(name, port, max(times // SLOW, 2))
    result: dict[str, Any] = {
        f"{kind}_{key}": value for kind, row in rows.items() for key, value in row.items()
    }
    return {**result, "met": all(map(clean, rows.values()))}


def clean(row: dict[str, float]) -> bool:
    """Return whether nothing counted remains, and memory grew within its limit."""
    left = sum(max(row[name], 0) for name in COUNTED)
    return row["memory_grown_mb"] <= MEMORY_LIMIT and left == 0


def leaks(name: str, port: str | None, times: int) -> dict[str, float]:
    """Return the growth of resources over `times` repetitions, after the first `WARM` of them."""
    warm = max(round(WARM * times), 1)
    with _without_messages(), Progress(console=Console(stderr=True), transient=True) as progress:
        bar = progress.add_task(f"opening {name} on {port or 'its twin'}", total=times)
        for _ in range(warm):
            open_once(name, port)
            progress.advance(bar)
        before = Resources.now()
        for _ in range(times - warm):
            open_once(name, port)
            progress.advance(bar)
        return {"times": times, **Resources.now().since(before)}


def open_once(name: str, port: str | None) -> None:
    """Open the robot, let it stand briefly, and close it without a crouch."""
    robot = Robot.open(name, port=port, arm=True)
    try:
        robot.stand(RUN)
        robot.stop(limp=True)
    finally:
        robot.close()


@contextmanager
def _without_messages() -> Iterator[None]:
    """Suppress the messages that appear each time a robot is armed."""
    console.quiet = True
    try:
        yield
    finally:
        console.quiet = False


@contextmanager
def emulated(name: str) -> Iterator[str]:
    """Serve the robot's buses on pseudo-terminals; yield the value of `--port` for them."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    with tempfile.TemporaryDirectory() as folder:
        emulator = context.Process(
            target=_serve, args=(name, Path(folder) / "bus", theirs), daemon=True
        )
        emulator.start()
        try:
            yield ours.recv()
        finally:
            emulator.kill()
            emulator.join()


def _serve(name: str, path: Path, pipe: Connection) -> None:
    address = parse_address(f"twin://{name}?clock=real")
    emulate(address, pty=path, on_ready=lambda emulator: pipe.send(port_of(emulator)))
