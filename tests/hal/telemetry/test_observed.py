from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.hal.telemetry.small_ring import JOINTS, observation, ring
from windup.hal.command import JointCommand
from windup.hal.observation import Observation
from windup.hal.telemetry.observed import observation_of
from windup.hal.telemetry.reader import TelemetryReader

WHOLE = observation(0.3)
assert WHOLE.imu is not None and WHOLE.base is not None
TURNED = replace(WHOLE.imu, orientation=np.array([0.6, 0.0, 0.8, 0.0]))
ODD = replace(WHOLE.joints, torque=np.full(2, np.nan), position=np.array([0.1 + 0.2, -0.0]))
CASES = {
    "all": WHOLE,
    "nothing": observation(0.3, whole=False),
    "orientation": replace(WHOLE, imu=TURNED),
    "no base": replace(WHOLE, base=None),
    "base of no confidence": replace(WHOLE, base=replace(WHOLE.base, confidence=0.0)),
    "odd numbers": replace(WHOLE, joints=ODD),
}


@pytest.mark.parametrize("seen", CASES.values(), ids=CASES)
def test_an_observation_is_read_bit_by_bit(seen: Observation, tmp_path: Path) -> None:
    writer = ring(tmp_path)
    hold = JointCommand.hold(JOINTS, np.zeros(2))
    writer.record(seen, hold, hold, 0.0, 0.0, 1, 0)
    with TelemetryReader(writer.path) as reader:
        tick = reader.latest()
    assert tick is not None
    again = observation_of(tick)
    assert again.time == seen.time
    for part in ("joints", "imu", "base"):
        mine, theirs = getattr(again, part), getattr(seen, part)
        assert (mine is None) == (theirs is None)
        for name in getattr(theirs, "__slots__", ()):
            same(getattr(mine, name), getattr(theirs, name), name)
    same(again.contacts, seen.contacts, "contacts")


def same(one: object, other: object, name: str) -> None:
    """Assert that two values are the same, bit by bit; a missing age of health is 0."""
    if name == "health_age" and other is None:
        other = np.zeros(2)
    assert (one is None) == (other is None), name
    assert np.asarray(one).tobytes() == np.asarray(other).tobytes(), name
