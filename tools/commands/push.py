"""`windup push`: push a twin that stands or walks, and see whether it stays up."""

from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import tyro

from windup.control.stepping.stepping_file import Support
from windup.hal.errors import UsageError
from windup.hal.ranges import Range
from windup.robots import load_robot
from windup.sim_twin.impact import ImpactGauge
from windup.tools.assembly.forbid import forbidden
from windup.tools.assembly.shape import check_walks
from windup.tools.assembly.stepping import WAYS, check_way, find_stepping, stepping_stance
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.behaviours.landings import format_landings
from windup.tools.behaviours.push_edge import LIGHT, Search
from windup.tools.behaviours.push_trial import PushPlan, push_robot
from windup.tools.behaviours.push_walk import format_push_walk, push_walking
from windup.tools.commands.push_envelope import Envelope
from windup.tools.measures.fall_report import fall_result, format_fall
from windup.tools.options.common import Common
from windup.tools.options.twin_options import WorldOptions
from windup.tools.robot.robot import Robot
from windup.tools.terminal.output import console, write_json
from windup.tools.terminal.picture import check_picture
from windup.tools.terminal.quantities import (
    Degrees,
    Delay,
    Duration,
    Height,
    Jobs,
    Seconds,
    Some,
    Speed,
)

Strength = Annotated[float, Range(0.0, 10_000.0, "N s")]


@dataclass(frozen=True, kw_only=True)
class Push(WorldOptions, Common):
    """Push a robot; it survives when only feet touch the ground and it rests, or walks on."""

    impulse: Strength | None = None
    """Impulse, N s."""
    direction: Degrees | Literal["random"] = 0.0
    """Where to, degrees: 0 forward, 90 to the left; random draws one for each push."""
    duration: Duration = 0.1
    """How long a push lasts, s."""
    height: Height | None = None
    """Where it meets the body, m above the ground; its centre of mass by default."""
    body: str | None = None
    """Which body is pushed; the torso by default."""
    at: Seconds | None = None
    """When the first push begins, s; 1 in a stand and 4 in a walk by default."""
    during: Literal["stand", "walk"] = "stand"
    """What the robot is at."""
    speed: Speed | None = None
    """Speed of the walk, m/s; the gait's default otherwise."""
    catch: bool = True
    """Hand over to the stepper what the walk cannot absorb."""
    times: Some = 1
    """How many pushes."""
    every: Duration = 1.0
    """From one push to the next, s."""
    way: str | None = None
    """How the robot meets it: hold, feet, capture, ip, momentum or predictive; that of its stepping
    by default."""
    stance: str | None = None
    """Pose to stand in; that of the robot's stepping by default."""
    delay: Delay | None = None
    """Delay of the servos, s."""
    support: Support | None = None
    """What the soles are taken to support: the hull of their points, or Kenwright's circles and
    capsule; what its stepping says by default."""
    forbid: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """Ground where no foot may come down, such as a hole: X,Y,R (circle), X,Y,W,H (rectangle about
    X,Y) or X1,Y1,X2,Y2,X3,Y3,.. (polygon), m, seen from between the feet at the start; several."""
    envelope: bool = False
    """Find the largest impulse that it survives in each direction, for each of --ways."""
    directions: Some = 16
    """Directions of the envelope."""
    ways: tuple[str, ...] = WAYS
    """Ways of the envelope."""
    jobs: Jobs | None = None
    """Processes of the envelope; one a core by default."""
    plot: Path | None = None
    """Draw the envelope into an image file."""

    def run(self) -> int:
        """Push; returns the exit status."""
        if self.envelope:
            return self._envelope().run()
        rows = []
        for seed in self.all_seeds:
            rows.append(self.one(seed, self.plan(seed), fall=True))
            console.print(format_push(rows[-1]), markup=False, soft_wrap=True)
            if "landings" in rows[-1]:
                console.print(format_landings(rows[-1]), markup=False, soft_wrap=True)
            if rows[-1]["reason"] == "interrupted":
                break
        good = sum(row["survived"] for row in rows)
        if self.seeds is not None:
            console.print(f"{good} of {len(rows)} seeds stayed up")
        result = rows[0] if self.seeds is None else {"robot": self.robot, "rows": rows}
        write_json(self.json, "push", result)
        if rows[-1]["reason"] == "interrupted":
            return 130
        clean = not any(row.get("on_forbidden") for row in rows)
        return 0 if good == len(rows) and clean else 1

    def _envelope(self) -> Envelope:
        """Return what is searched, in all directions and all ways."""
        with self.open_robot(self.seed) as robot:
            scale = max(round(float(robot.twin.model.body_mass.sum()) / LIGHT), 1)
        directions = (np.arange(self.directions) * 360.0 / self.directions).tolist()
        plan = self.plan(self.seed)
        searches = [
            Search(self.one, self.seed, plan, way, direction, scale)
            for way in self.ways
            for direction in directions
        ]
        return Envelope(
            self.robot, directions, self.ways, searches, self.jobs, self.json, self.plot
        )

    def one(self, seed: int, plan: PushPlan, *, fall: bool = False) -> dict[str, Any]:
        """Return the result of one trial; with `fall` a robot that falls does so to the end."""
        world = self.world(load_robot(self.robot), seed)
        steps = self.during == "stand" or self.catch
        rate = self.rate or (find_stepping(load_robot(self.robot)).rate if steps else None)
        with replace(self, rate=rate).open_robot(seed, delay=self.delay, world=world) as robot:
            result: dict[str, Any] = {"reason": "interrupted", "survived": False, "seed": seed}
            robot.protect = self.protect and fall
            gauge = ImpactGauge(robot.twin) if fall else None
            with suppress(KeyboardInterrupt):
                result = self._push(robot, plan, fall)
            if gauge is not None:
                result |= fall_result(gauge)
        return result

    def _push(self, robot: Robot, plan: PushPlan, fall: bool) -> dict[str, Any]:
        if self.during == "stand":
            return push_robot(robot, plan, to_the_end=fall)
        options = WalkOptions(speed=self.speed, catch=plan.way if self.catch else None)
        return push_walking(robot, plan, options, to_the_end=fall)

    def plan(self, seed: int) -> PushPlan:
        """Return what is done with a seed."""
        impulse = self.impulse or 0.0
        directions: list[float] = [0.0 if self.direction == "random" else self.direction]
        directions *= self.times
        if self.direction == "random":
            draw = np.random.default_rng([11, seed])
            directions = draw.uniform(-180.0, 180.0, self.times).round(1).tolist()
        return PushPlan(
            self.way or find_stepping(load_robot(self.robot)).way,
            impulse,
            tuple(directions),
            self.duration,
            self.height,
            self._first,
            self.every,
            self.body,
            self.stance,
            self.forbid,
            self.support,
        )

    @property
    def _first(self) -> float:
        """When the first push begins, s."""
        return self.at if self.at is not None else 1.0 if self.during == "stand" else 4.0

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        check_walks(load_robot(self.robot), "bear pushes")
        if self.envelope == (self.impulse is not None):
            raise UsageError("give --impulse N_S, or --envelope to find the largest ones")
        if self.plot is not None and not self.envelope:
            raise UsageError("--plot draws an envelope: give --envelope, or leave it away")
        check_picture(self.plot)
        self._check_walk()
        forbidden(self.forbid)
        for way in self.ways if self.way is None else (self.way, *self.ways):
            check_way(way)
        stepping_stance(load_robot(self.robot), self.stance)

    def _check_walk(self) -> None:
        """Raise what only a robot that stands, or one that walks, can do."""
        if self.during == "walk":
            names = ("envelope", "stance", "forbid", "support")
            wrong = [name for name in names if getattr(self, name)]
            what = "is for a robot that stands; leave --during walk away"
        else:
            wrong = [] if self.speed is None else ["speed"]
            what = "is for a robot that walks; give --during walk"
        if wrong:
            raise UsageError(f"--{wrong[0]} {what}")


def format_push(row: dict[str, Any]) -> str:
    """Return the sentence of one trial."""
    if "robot" not in row:
        return "interrupted"
    toward = ", ".join(f"{direction:g}" for direction in row["directions"])
    push = f"{row['impulse']:g} N s toward {toward} degrees"
    steps = f"{row['steps']} steps" if row["steps"] != 1 else "1 step"
    if not row["survived"]:
        how = f"fell onto {row['touched'][0]}" if row["touched"] else row["reason"]
        return f"{row['robot']} {how} after {push} ({row['way']}, {steps}); {format_fall(row)}"
    if "during" in row:
        return f"{row['robot']} walks on after {push} ({row['way']}): {format_push_walk(row)}"
    return (
        f"{row['robot']} stays up after {push} ({row['way']}): {steps}, still after "
        f"{row['settling_s']:.2f} s, feet {1000 * row['astray_m']:.0f} mm from the stance"
    )
