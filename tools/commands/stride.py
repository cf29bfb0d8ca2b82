"""`windup stride`: walk and halt in any direction as the inverted pendulum plans it."""

from dataclasses import dataclass
from typing import Annotated, Any

import tyro

from windup.robots import load_robot
from windup.tools.assembly.shape import check_walks
from windup.tools.behaviours.striding import (
    Leg,
    build_strider,
    check_legs,
    find_stride,
    read_leg,
    stride,
)
from windup.tools.options.common import Common
from windup.tools.options.twin_options import TwinOptions
from windup.tools.terminal.output import console, write_json
from windup.tools.terminal.quantities import Degrees, Duration, Speed


@dataclass(frozen=True, kw_only=True)
class Stride(TwinOptions, Common):
    """Walk in any direction and halt, with steps that an inverted pendulum plans.

    `windup walk` is another walk: a limit cycle of a pose graph, faster, and not to be halted
    between two steps.
    """

    speed: Speed = 0.1
    """m/s; 0 stands, or turns on the spot."""
    heading: Degrees = 0.0
    """Where to, degrees from how it faces at the start: 0 forward, 90 to the left."""
    face: Degrees = 0.0
    """Where its trunk should look, degrees: it turns there step by step."""
    then: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """What to do later: SECONDS,SPEED[,HEADING[,FACE]], such as 4,0.1,90 or 6,0; several."""
    seconds: Duration = 8.0
    """When it halts, s."""

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        robot, legs = load_robot(self.robot), self.legs()
        check_walks(robot, "stride")
        check_legs(legs, self.seconds, find_stride(robot))
        build_strider(robot, legs, self.seconds)

    def run(self) -> int:
        """Stride; returns the exit status."""
        rows: list[dict[str, Any]] = []
        for seed in self.all_seeds:
            rows.append(self.one(seed))
            console.print(format_stride(rows[-1]), markup=False, soft_wrap=True)
            if rows[-1]["reason"] == "interrupted":
                break
        good = sum(row["good"] for row in rows)
        if self.seeds is not None:
            console.print(f"{good} of {len(rows)} seeds halted on their feet")
        result = rows[0] if self.seeds is None else {"robot": self.robot, "rows": rows}
        write_json(self.json, "stride", result)
        if rows[-1]["reason"] == "interrupted":
            return 130
        return 0 if good == len(rows) else 1

    def legs(self) -> list[Leg]:
        """Return what to do, one after the other.

        Raises:
            UsageError: It cannot be, or is written in another way.
        """
        legs = [Leg(0.0, self.speed, self.heading, self.face)]
        for text in self.then:
            legs.append(read_leg(text, legs[-1]))
        return legs

    def one(self, seed: int, *, path: bool = False) -> dict[str, Any]:
        """Return how it went with one seed; with its `path` where somebody draws it."""
        description, legs = load_robot(self.robot), self.legs()
        how = find_stride(description)
        check_legs(legs, self.seconds, how)
        strider = build_strider(description, legs, self.seconds)
        with self.open_robot(seed, world=self.world(description, seed)) as robot:
            robot.start_at(how.stance, needs_imu=True)
            if (disturb := self.disturb()) is not None:
                disturb(robot)
            return stride(robot, strider, legs, self.seconds, path=path)


def format_stride(row: dict[str, Any]) -> str:
    """Return how it went, in a sentence."""
    x, y = row["moved_m"]
    went = (
        f"{row['robot']} took {row['steps']} steps in {row['seconds']:.1f} s "
        f"to ({x:.2f}, {y:.2f}) m, turned by {row['turned_deg']:.0f} degrees"
    )
    speeds = [
        f"{leg['measured_speed']:.3f} m/s toward {leg['measured_heading']:.0f} degrees "
        f"(ordered {leg['speed']:g}, {leg['heading']:g})"
        for leg in row["legs"]
        if leg["measured_speed"] is not None and leg["speed"] > 0.0
    ]
    how = "halted" if row["good"] else row["reason"]
    return "; ".join([went, *speeds, how])
