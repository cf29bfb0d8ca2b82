"""Is the IMU's word to be trusted? Silent, frozen, not a number, or spinning.

A body that turns shows it twice: the gyroscope says so, and gravity comes from another side. The
vertical that the gyroscope carries along, drawn slowly to the accelerometer, is compared with the
accelerometer. A fall does not look like a spin: who falls is weightless by as much as they have
tilted, and pushes shake the accelerometer; only where it shows nothing but gravity, for a while,
and from another side, is the gyroscope wrong. Turns about the vertical show in no accelerometer:
there a robot whose joints stand still does not turn on its feet.

A frozen sensor repeats one sample, gyroscope and accelerometer alike. Real ones are never that
still, but emulated ones of a robot that hands hold, or that lies, are: a sample is frozen if the
joints have moved meanwhile.
"""

from math import acos, exp, pi, sqrt
from typing import NamedTuple

import numpy as np

from hal.errors import ImuError
from hal.guard.finding import Finding, Saying
from hal.joints import Array
from hal.observation import ImuState, Observation

GRAVITY = 9.81
SILENT = 0.25
"""Age of the newest sample, s."""
FROZEN = 0.5
"""Time without a new sample, s."""
MOVED = 0.03
"""What a joint has to have moved meanwhile, rad."""
DISAGREE = 0.5
"""Angle between the vertical of the gyroscope and that of the accelerometer, rad."""
AROUND = 1.0
"""Turn about the vertical while all joints stand still, rad."""
STILL = 0.5
"""A joint slower than this stands still, rad/s."""
QUIET = 0.1
"""How far from gravity an accelerometer may be that feels nothing else, as a share."""
PERSIST = 0.1
"""How long gyroscope and accelerometer have to disagree, s."""
DRAW = 1.0
"""Time constant with which the accelerometer draws the vertical, s."""
