"""What a balanced walk publishes: regulation variables, targets, the last plan, and scalings."""

from collections.abc import Sequence

import numpy as np

from windup.control.pose_graph.gait import Gait
from windup.control.regulation.step_record import StepRecord
from windup.control.regulation.variables import RegulationVariable
from windup.control.steering.steering import Steering
from windup.hal.joints import Array
from windup.hal.publishing.controller_block import MOST_VALUES, BlockNames

REASONS = ("open loop", "waiting for the plan", "planned", "replanned after a disturbance")
COMMAND = (("speed", "m/s"), ("side", "m/s"), ("turn", "rad/s"))


def walk_names(
    gait: Gait, regulation: Sequence[RegulationVariable], perturbations: Sequence[str]
) -> BlockNames:
    """Return the names for a gait with r regulation variables and the r perturbations for them.

    Values: the regulation variables at the end of the last step, the targets of the present one,
    the scalings K that balance it, the commanded velocity, and the scalings of all perturbations,
    as many as fit.
    """
    values = [
        *((f"regulation.{variable.name}", variable.unit) for variable in regulation),
        *((f"target.{variable.name}", variable.unit) for variable in regulation),
        *((f"plan.{name}", "1") for name in perturbations),
        *COMMAND,
        *((f"scaling.{name}", "1") for name in gait.perturbations),
    ][:MOST_VALUES]
    return BlockNames(
        phases=gait.graph.names,
        reasons=REASONS,
        values=tuple(name for name, _ in values),
        units=tuple(unit for _, unit in values),
    )


def reason_of(planned: bool, waiting: bool, replanned: bool) -> int:
    """Return the index of the reason for the present scalings.

    Args:
        planned: There is a planner.
        waiting: Its answer for the present step is still to come.
        replanned: It was asked again within the step.
    """
    if not planned:
        return 0
    return 1 if waiting else 2 + replanned


def put_walk(
    values: Array,
    records: Sequence[StepRecord],
    target: Array,
    plan: Array | None,
    steering: Steering,
    scale: Array,
) -> None:
    """Put in the values in the order of `walk_names`.

    Args:
        values: (v,) the values of a block.
        records: The finished steps.
        target: (r,) targets of the present step.
        plan: (r,) scalings that balance the present step, or None if there are none yet.
        steering: The steering; its speeds are those it has ramped to.
        scale: (p,) scalings of all perturbations in effect.
    """
    unknown = np.full(len(target), np.nan)
    parts = (
        records[-1].regulation if records else unknown,
        target,
        unknown if plan is None else plan,
        (steering.speed.present, steering.side.present, steering.command.turn),
        scale,
    )
    whole = np.concatenate(parts)
    values[...] = whole[: len(values)]
