"""What a fall did to a twin, for reports."""

from typing import Any

from sim_twin.impact import ImpactGauge


def fall_result(gauge: ImpactGauge) -> dict[str, Any]:
    """Return what was measured: speeds m/s into the floor, loads as shares of stall torque, s."""
    return {
        "torso_impact_m_s": gauge.torso,
        "head_impact_m_s": gauge.head,
        "torso_knock_m_s": gauge.knock,
        "peak_load": float(gauge.load.max()),
        "peak_joint": gauge.busiest,
        "overload_s": gauge.overload,
    }


def fall_said(gauge: ImpactGauge) -> str:
    """Return the same for people."""
    return (
        f"torso hits the floor at {gauge.torso:.2f} m/s, head at {gauge.head:.2f} m/s; "
        f"the torso loses {gauge.knock:.2f} m/s in 10 ms at most; "
        f"peak load {100.0 * gauge.load.max():.0f} % of stall at {gauge.busiest}"
    )
