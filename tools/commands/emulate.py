"""`windup emulate`: serve a robot's emulated servo buses to other programs, in real time.

MuJoCo is imported for a robot only, so that a bench of servos starts fast.
"""

import os
import signal
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Annotated
from urllib.parse import urlencode

import tyro

from windup.hal.errors import PortError, UsageError
from windup.hal.ranges import Range
from windup.sim_twin.wire import Address, parse_address
from windup.sim_twin.wire.faults.fault_text import parse_rules
from windup.sim_twin.wire.serve.emulate import Emulator, emulate
from windup.sim_twin.wire.serve.outlet import BusOutlet
from windup.sim_twin.wire.world.address import BENCH, SCHEME
from windup.sim_twin.wire.world.hand import parse_hands
from windup.tools.terminal.command import Command
from windup.tools.terminal.output import console
from windup.tools.terminal.quantities import Seed
from windup.tools.terminal.writing import check_writable


@dataclass(frozen=True, kw_only=True)
class Emulate(Command):
    """Serve the servos of a robot's twin, or servos alone, to any program, until Ctrl-C."""

    robot: Annotated[str | None, tyro.conf.Positional, tyro.conf.arg(metavar="[ROBOT]")] = None
    """A robot's name, the path of its folder, or a whole twin:// URL (twin://bench?servos=...)."""
    servos: str = ""
    """Servos without a robot: models and ids, STS3215:1-6 or XM430-W350:1-20,XL430:30; all of one
    protocol."""
    pty: Path | None = None
    """Serve on a pseudo-terminal, to be found under this path. It loses some of what a program
    writes and flushes at once (tcflush, as pypot does); --tcp loses nothing."""
    tcp: Annotated[int, Range(0, 65_535)] | None = None
    """Serve on this TCP port of this machine; 0: any."""
    faults: str = ""
    """What goes wrong: drop:0.01,unplug:at=5:seconds=1,...; a wrong word gets the list."""
    seed: Seed = 0
    """Seed of the faults."""
    supply: Annotated[float, Range(0.0, 60.0, "V", above=True)] | None = None
    """Voltage of the servos, V; the robot's own by default."""
    hold: bool = False
    """Take the robot up again whenever all its servos are limp; it is held anyway until the first
    time that all have torque."""
    hand: str = ""
    """A hand turns limp joints to and fro: r_knee:20:3s,... (joint or, on a bench, id; degrees;
    seconds one way)."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        address = self._address()
        parse_rules(address.faults)
        parse_hands(address.hand)
        check_writable(self.pty)

    def warn(self) -> None:
        """Say that the robot's MJCF is doubtful; see `Command.warn`."""
        if (robot := self._address().robot) != BENCH:
            from windup.robots import load_robot
            from windup.robots.inspection.doubt_once import doubt_once

            doubt_once(load_robot(robot))

    def run(self) -> int:
        """Serve; returns the exit status."""
        address = self._address()
        ready = partial(_on_ready, "" if address.robot == BENCH else self.robot or "")
        try:
            emulate(address, self.pty, self.tcp, on_ready=ready)
        except OSError as error:
            why = os.strerror(error.errno) if error.errno else str(error)
            raise PortError(f"cannot serve: {why}; give another --pty, or --tcp 0") from None
        console.print("windup emulate: stopped")
        return 0

    def _address(self) -> Address:
        """Return the world to serve; options win over the URL.

        Raises:
            UsageError: Neither a robot nor servos are given, or both, or they cannot be.
        """
        if (self.robot is None) is not bool(self.servos):
            raise UsageError("give either a ROBOT, or servos without one: --servos STS3215:1-6")
        name = self.robot or f"{BENCH}?{urlencode({'servos': self.servos})}"
        address = parse_address(name if "://" in name else f"{SCHEME}://{name}")
        return replace(
            address,
            clock="real",
            faults=self.faults or address.faults,
            seed=self.seed or address.seed,
            supply=address.supply if self.supply is None else self.supply,
            hold="always" if self.hold else address.hold,
            hand=self.hand or address.hand,
        )


def _on_ready(robot: str, emulator: Emulator) -> None:
    """Say where it serves, and end cleanly when told to; `robot` is "" for servos of none."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: emulator.stop())
    for outlet in emulator.outlets:
        console.print(_describe(outlet), markup=False, soft_wrap=True)
    if robot:
        console.print(_how_to_run(robot, emulator), markup=False, soft_wrap=True)
    console.print("Ctrl-C ends it", markup=False)


def _how_to_run(robot: str, emulator: Emulator) -> str:
    """Return the command that stands the robot on these buses."""
    name = parse_address(robot).robot if "://" in robot else robot
    outlets = {outlet.bus.name: outlet.name for outlet in emulator.outlets}
    ports = ",".join(f"{bus}={name}" for bus, name in outlets.items())
    port = ports if len(outlets) > 1 else next(iter(outlets.values()))
    return f"in another terminal: windup stand {name} --port {port} --arm"


def _describe(outlet: BusOutlet) -> str:
    bus = outlet.bus
    if not bus.devices:
        what = f"bus {bus.name!r} (it sends by itself at {bus.baud} baud)"
        return f"{what} on {outlet.name}; try: python -m serial.tools.miniterm {outlet.name}"
    what = f"bus {bus.name!r} ({len(bus.devices)} devices at {bus.baud} baud)"
    return f"{what} on {outlet.name}; try: windup scan {outlet.name} --baud {bus.baud}"
