"""What `windup step` and `windup footprints` share: walk on each seed, and say how it went."""

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from windup.control.footprints.footprints import Footprint
from windup.robots import load_robot
from windup.tools.behaviours.directed import (
    DirectedWalk,
    build_directed,
    loop_rate,
    walk_prints,
)
from windup.tools.options.common import Common
from windup.tools.options.twin_options import TwinOptions
from windup.tools.terminal.output import console, write_json


@dataclass(frozen=True, kw_only=True)
class DirectedOptions(TwinOptions, Common, ABC):
    """Options of every command that walks footprints."""

    @abstractmethod
    def prints(self, seed: int) -> list[Footprint]:
        """Return what to walk with this seed."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        build_directed(load_robot(self.robot), self.prints(self.all_seeds[0]))

    def walk(self, command: str) -> int:
        """Walk on every seed; returns the exit status."""
        rows: list[dict[str, Any]] = []
        for seed in self.all_seeds:
            walk = self._one(seed)
            self._say(walk)
            rows.append({"robot": self.robot, "seed": seed, **walk.record()})
            if walk.reason == "interrupted":
                break
        if self.seeds is not None:
            good = sum(row["good"] for row in rows)
            console.print(f"{good} of {len(rows)} seeds put every foot where it should be")
        result = rows[0] if self.seeds is None else {"robot": self.robot, "rows": rows}
        write_json(self.json, command, result)
        if rows[-1]["reason"] == "interrupted":
            return 130
        return 0 if all(row["good"] for row in rows) else 1

    def _one(self, seed: int) -> DirectedWalk:
        description = load_robot(self.robot)
        controller = build_directed(description, self.prints(seed))
        paced = replace(self, rate=self.rate or loop_rate(description))
        with paced.open_robot(seed, world=self.world(description, seed)) as robot:
            robot.start_at(controller.how.stance, needs_imu=True)
            if (disturb := self.disturb()) is not None:
                disturb(robot)
            return walk_prints(robot, controller)

    def _say(self, walk: DirectedWalk) -> None:
        """Say where the feet came down; a step each where there are few."""
        for number, fall in enumerate(walk.falls, 1):
            if self.seeds is not None:
                break
            x, y, yaw = fall.place
            console.print(
                f"{number:3d} {walk.names[fall.wanted.foot]:10s} at ({x:.3f}, {y:.3f}) m, "
                f"{np.degrees(yaw):.0f} degrees: {1e3 * fall.away:.1f} mm and "
                f"{fall.turned:.1f} degrees off"
            )
        console.print(format_directed(self.robot, walk), markup=False, soft_wrap=True)


def format_directed(name: str, walk: DirectedWalk) -> str:
    """Return how it went, in a sentence."""
    done = f"{name} took {len(walk.falls)} of {len(walk.prints)} steps in {walk.seconds:.1f} s"
    if walk.reason != "done":
        return f"{done} and {walk.reason}"
    away = max(fall.away for fall in walk.falls)
    turned = max(abs(fall.turned) for fall in walk.falls)
    fine = f", and {1e3 * walk.how.close:.0f} mm and {walk.how.turned:.0f} degrees are fine"
    verdict = "" if walk.good else fine
    return f"{done}; farthest off {1e3 * away:.1f} mm and {turned:.1f} degrees{verdict}"
