"""What a stepper publishes: its phase, the capture point, and where the swing foot goes."""

from typing import Final, Literal

import numpy as np

from windup.control.kinematics.momenta import Momenta, capture_point
from windup.hal.joints import Array
from windup.hal.publishing.controller_block import BlockNames, ControllerBlock
from windup.hal.publishing.run_state import RunState

StepperPhase = Literal["stand", "swing", "land", "comfort"]
PHASES: Final[tuple[StepperPhase, ...]] = ("stand", "swing", "land", "comfort")
REASONS: Final = (
    "the feet support the robot",
    "the trigger point has left the support",
    "the feet go back to the stance",
)
STEPPER_NAMES: Final = BlockNames(
    phases=PHASES,
    reasons=REASONS,
    values=("capture_point.x", "capture_point.y", "swing_target.x", "swing_target.y"),
    units=("m",) * 4,
)
"""Points in the world frame; the target is NaN while no foot swings."""


def publish_stepper(
    block: ControllerBlock, phase: StepperPhase, momenta: Momenta, target: Array | None
) -> None:
    """Fill in the block of a stepper.

    Args:
        block: The block.
        phase: Present phase.
        momenta: Momenta of the robot.
        target: (2,) target of the swing foot, m, or None.
    """
    block.run_state = RunState.STANDING if phase == "stand" else RunState.STEPPING
    block.phase = PHASES.index(phase)
    block.reason = {"stand": 0, "comfort": 2}.get(phase, 1)
    block.values[:2] = capture_point(momenta)
    block.values[2:] = np.nan if target is None else target
