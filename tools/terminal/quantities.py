"""Types of the numbers of commands and calls: their units and plausible ranges.

The ranges are wide and exclude only obvious mistakes. The narrower limits of a robot or a gait are
checked elsewhere.
"""

from typing import Annotated

from windup.hal.ranges import Range

MAX_TIME = 1e7  # about four months, s

Seed = Annotated[int, Range(0, 2**32 - 1)]
Count = Annotated[int, Range(1, 1_000_000)]
Some = Annotated[int, Range(1, 1_000)]
Seeds = Annotated[int, Range(1, 100_000)]
Jobs = Annotated[int, Range(1, 1_024)]
Rate = Annotated[float, Range(1.0, 10_000.0, "Hz")]
Seconds = Annotated[float, Range(0.0, MAX_TIME, "s")]
Duration = Annotated[float, Range(0.0, MAX_TIME, "s", above=True)]
Delay = Annotated[float, Range(0.0, 1.0, "s")]
Speed = Annotated[float, Range(-100.0, 100.0, "m/s")]
TurnRate = Annotated[float, Range(-3_600.0, 3_600.0, "degrees/s")]
Degrees = Annotated[float, Range(-3_600.0, 3_600.0, "degrees")]
Noise = Annotated[float, Range(0.0, 90.0, "degrees")]
Metres = Annotated[float, Range(-10_000.0, 10_000.0, "m")]
Height = Annotated[float, Range(0.0, 10.0, "m")]
Impulse = Annotated[float, Range(-10_000.0, 10_000.0, "N s")]
