"""Joint limits in degrees and in counts of the servos, as rows and as a table."""

from typing import Any, Final

import numpy as np
from rich.table import Table

from windup.robots import RobotDescription

KEYS: Final = (
    "joint",
    "lower_deg",
    "upper_deg",
    "torque",
    "servo",
    "bus",
    "id",
    "counts",
    "travel",
)


def travel_rows(robot: RobotDescription) -> list[dict[str, Any]]:
    """Return a row for each joint; servo, bus, id, counts and travel are None without a servo.

    `counts` are the joint's limits in counts of its servo, `travel` the servo's own limits.
    """
    rows = []
    for joint, mount in zip(robot.joints.joints, robot.servos, strict=True):
        ends = (joint.lower, joint.upper)
        row: dict[str, Any] = dict.fromkeys(KEYS)
        row |= {"joint": joint.name, "torque": joint.torque}
        row |= {"lower_deg": float(np.degrees(ends[0])), "upper_deg": float(np.degrees(ends[1]))}
        if mount is not None:
            row |= {"servo": mount.model.name, "bus": mount.bus, "id": mount.id}
            row["counts"] = [round(mount.zero + mount.counts_per_rad * end) for end in ends]
            row["travel"] = [mount.first_count, mount.last_count]
        rows.append(row)
    return rows


def travel_table(rows: list[dict[str, Any]]) -> Table:
    """Return the rows as a table for the terminal."""
    table = Table(box=None, padding=(0, 2, 0, 0))
    for title in ("joint", "degrees", "N m", "servo", "bus", "id", "counts", "of"):
        table.add_column(title, no_wrap=True)
    for row in rows:
        limits = f"{row['lower_deg']:.0f}..{row['upper_deg']:.0f}"
        torque = f"{row['torque']:.3g}" if np.isfinite(row["torque"]) else "any"
        words = [row["joint"], limits, torque]
        if row["servo"] is not None:
            ends = [f"{low}..{high}" for low, high in (row["counts"], row["travel"])]
            words += [row["servo"], row["bus"], str(row["id"]), *ends]
        table.add_row(*words)
    return table
