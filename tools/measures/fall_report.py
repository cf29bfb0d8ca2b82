"""Reports the impacts and loads of a fall."""

from typing import Any

from windup.sim_twin.impact import ImpactGauge
from windup.tools.measures.load_gauge import format_load


def fall_result(gauge: ImpactGauge) -> dict[str, Any]:
    """Return impact speeds, m/s, load as a share of stall torque, and time of overload, s."""
    return {
        "torso_impact_m_s": gauge.torso,
        "head_impact_m_s": gauge.head,
        "torso_knock_m_s": gauge.velocity_jump,
        "peak_load": float(gauge.load.max()),
        "peak_joint": gauge.most_loaded_joint,
        "overload_s": gauge.overload,
    }


def format_fall(result: dict[str, Any]) -> str:
    """Return a sentence about a fall, from a result with these measurements."""
    return (
        f"torso hits the floor at {result['torso_impact_m_s']:.2f} m/s, "
        f"head at {result['head_impact_m_s']:.2f} m/s; "
        f"the torso's speed changes by {result['torso_knock_m_s']:.2f} m/s in 10 ms at most; "
        f"{format_load(result['peak_load'], result['peak_joint'])}"
    )
