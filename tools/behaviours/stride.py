"""Walking and halting in any direction, with steps that an inverted pendulum plans."""

from dataclasses import dataclass
from typing import Annotated, Any

import tyro

from windup.control.stride.strider import Strider
from windup.hal.controller import Predictor
from windup.robots import RobotDescription
from windup.tools.assembly.shape import check_walks
from windup.tools.behaviours.behaviour import Behaviour
from windup.tools.behaviours.report import Report
from windup.tools.behaviours.run_record import RunRecord
from windup.tools.behaviours.striding import (
    Leg,
    StrideTrace,
    build_strider,
    check_legs,
    find_stride,
    read_leg,
    stride,
)
from windup.tools.terminal.quantities import Degrees, Duration, Speed


@dataclass(frozen=True, kw_only=True)
class StrideOptions:
    """Options of striding."""

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

    def legs(self) -> list[Leg]:
        """Return what to do, one after the other.

        Raises:
            UsageError: It cannot be, or is written in another way.
        """
        legs = [Leg(0.0, self.speed, self.heading, self.face)]
        for text in self.then:
            legs.append(read_leg(text, legs[-1]))
        return legs


class Stride(Behaviour[StrideOptions]):
    """Follow orders of speed and heading, and halt."""

    name, Options, done = "stride", StrideOptions, "halted on their feet"

    def build(
        self, robot: RobotDescription, options: StrideOptions, predictor: Predictor | None
    ) -> Strider:
        """Return what strides.

        Raises:
            UsageError: The robot cannot stride, or not as the options say.
        """
        check_walks(robot, "stride")
        legs = options.legs()
        check_legs(legs, options.seconds, find_stride(robot))
        return build_strider(robot, legs, options.seconds)

    def perform(self, run: RunRecord[StrideOptions]) -> None:
        """Stride from the stance, and look where it goes."""
        robot, options = run.robot, run.options
        strider = self.build(robot.description, options, None)
        robot.start_at(find_stride(robot.description).stance, needs_imu=True)
        run.disturb_twin()
        run.measured = trace = StrideTrace(robot, strider, options.legs(), options.seconds)
        stride(trace)

    def report(self, run: RunRecord[StrideOptions]) -> Report:
        """Return how fast it went where, and whether it halted."""
        trace: StrideTrace = run.measured
        result = trace.result()
        return Report(result["good"], result["reason"], result, (format_stride(result),))


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


STRIDE = Stride()
