"""Limits of a joint: those of robot.toml, else of the MJCF, else the servo's range of counts."""

from collections.abc import Iterator
from math import isnan, pi

import mujoco
from msgspec.structs import replace

from windup.hal.families import family_of, servo_model
from windup.hal.servos.servo_model import ServoMount
from windup.robots import mjcf
from windup.robots.records import JointEntry

TURNS = 255
"""Servo turns either way that limit a joint without limits of its own; a servo counts 256."""


def with_limits(entry: JointEntry, model: mujoco.MjModel) -> JointEntry:
    """Return a joint with omitted limits filled in; they stay nan if they are given nowhere."""
    if entry.name not in mjcf.hinge_names(model):
        return entry
    hinge = model.joint(entry.name)
    if model.jnt_limited[hinge.id]:
        low, high = (float(end) for end in hinge.range)
    elif entry.mode == "extended" or entry.servo is None:
        high = 2.0 * pi * TURNS / entry.ratio
        low = -high
    else:
        return entry
    lower = low if isnan(entry.lower) else entry.lower
    upper = high if isnan(entry.upper) else entry.upper
    return replace(entry, lower=lower, upper=upper)


def travel_mistakes(entry: JointEntry) -> Iterator[str]:
    """Yield messages about limits of a joint that its servo cannot reach in its mode."""
    servo = servo_model(str(entry.servo))
    can = family_of(servo.name).extended is not None
    if entry.mode == "extended":
        if not can:
            yield (
                f'mode "extended" is for Dynamixel X servos; a {entry.servo} is used within one '
                "turn: leave mode out, and give lower and upper"
            )
        return
    zero = servo.middle if entry.zero is None else entry.zero
    mount = ServoMount(servo, entry.bus or "", entry.id or 0, entry.sign, zero, entry.ratio)
    ends = sorted(zero + mount.counts_per_rad * angle for angle in (entry.lower, entry.upper))
    if ends[0] >= 0.0 and ends[1] <= servo.last_count:
        return
    long = ends[1] - ends[0] > servo.last_count
    remedy = "narrow lower and upper" if long else "narrow lower and upper, or give another zero"
    yield (
        f"lower {entry.lower:g} to upper {entry.upper:g} rad (ratio {entry.ratio:g}, zero {zero}) "
        f"is {ends[0]:.0f} to {ends[1]:.0f} counts, and a {entry.servo} has 0 to "
        f"{servo.last_count} in position mode: {remedy}"
        + (', or give mode = "extended"' if can else "")
    )
