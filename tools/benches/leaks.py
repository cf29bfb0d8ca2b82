"""What is left behind by opening a robot, running it for a moment and closing it, many times."""

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

from windup.hal.telemetry.layout import runtime_folder
from windup.robots import load_robot
from windup.sim_twin.wire import parse_address
from windup.sim_twin.wire.serve.emulate import emulate
from windup.tools.benches.safety.emulated import port_of
from windup.tools.robot.robot import Robot
from windup.tools.terminal.output import console

RUN: Final = 0.1
"""How long it stands each time, s."""
WARM: Final = 0.1
"""The part of the times after which counting begins: by then all that is kept once is there."""
SLOW: Final = 20
"""On a pseudo-terminal, in real time, it is opened so many times less often."""
MEMORY_LIMIT: Final = 5.0
"""Growth of memory, MB."""
COUNTED: Final = ("descriptors", "threads", "processes", "files")
"""What there may be no more of than before."""


@dataclass(frozen=True)
class Traces:
    """What this process has.

    Attributes:
        memory: In RAM, MB.
        descriptors: Open files, pipes and ports.
        threads: Threads.
        processes: Child processes.
        files: Files in the user's runtime folder.
    """

    memory: float
    descriptors: int
    threads: int
    processes: int
    files: int

    @classmethod
    def now(cls) -> "Traces":
        """Look, when nothing is left that nobody refers to."""
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

    def since(self, before: "Traces") -> dict[str, float]:
        """Return what has come since `before`."""
        counts = {name: getattr(self, name) - getattr(before, name) for name in COUNTED}
        return {"memory_grown_mb": round(self.memory - before.memory, 2), **counts}


def measure_leaks(name: str, times: int) -> dict[str, Any]:
    """Return what opening a robot so often leaves: as a twin, through its bus, on a port.

    Args:
        name: The robot.
        times: How often; on a pseudo-terminal a twentieth of that.
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
    """Return whether nothing worth a name is left."""
    left = sum(max(row[name], 0) for name in COUNTED)
    return row["memory_grown_mb"] <= MEMORY_LIMIT and left == 0


def leaks(name: str, port: str | None, times: int) -> dict[str, float]:
    """Return what is left after `times`, beside what there was after the first of them."""
    warm = max(round(WARM * times), 1)
    with _unsaid(), Progress(console=Console(stderr=True), transient=True) as progress:
        bar = progress.add_task(f"opening {name} on {port or 'its twin'}", total=times)
        for _ in range(warm):
            open_once(name, port)
            progress.advance(bar)
        before = Traces.now()
        for _ in range(times - warm):
            open_once(name, port)
            progress.advance(bar)
        return {"times": times, **Traces.now().since(before)}


def open_once(name: str, port: str | None) -> None:
    """Open the robot, let it stand for a moment, and close it without a crouch."""
    robot = Robot.open(name, port=port, arm=True)
    try:
        robot.stand(RUN)
        robot.stop(limp=True)
    finally:
        robot.close()


@contextmanager
def _unsaid() -> Iterator[None]:
    """Leave out what is said each time a robot is armed."""
    console.quiet = True
    try:
        yield
    finally:
        console.quiet = False


@contextmanager
def emulated(name: str) -> Iterator[str]:
    """Serve the robot's buses on pseudo-terminals; what `--port` takes for them."""
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
