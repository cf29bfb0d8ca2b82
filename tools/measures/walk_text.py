"""Formats the result of a walk as one line."""

from typing import Any

Result = dict[str, Any]


def format_walk(result: Result) -> str:
    """Return the line; values that were not measured are omitted."""
    if result["sim_time_s"] <= 0.0:
        return f"{result['robot']} did not walk: {result['reason']}"
    ratio = result["sim_time_s"] / max(result["wall_time_s"], 1e-9)
    return (
        f"{result['robot']} {_end(result)}{_pace(result)}: {result['distance_m']:.2f} m forward, "
        f"{result['lateral_m']:+.2f} m to the left, heading {result['heading_deg']:+.1f} degrees, "
        f"{ratio:.1f} x real time{_flying(result)}{_sliding(result)}"
        f"{_caught(result)}{_crossing(result)}"
    )


def format_summary(whole: Result) -> str:
    """Return the line about the walks of several seeds."""
    speed = whole["speed_mean_m_s"]
    pace = "" if speed is None else f", mean speed {speed:.3f} m/s"
    return (
        f"{whole['walked']} of {whole['runs']} runs walked to the end{pace}, "
        f"heading within {whole['heading_max_deg']:.1f} degrees"
        f"{', feet cross in ' + str(whole['crossed']) if whole['crossed'] else ''}"
    )


def _end(result: Result) -> str:
    """Return how the walk ended."""
    if result["fell"]:
        return f"fell in step {result['steps'] + 1} of {result['steps_requested']}"
    if result["reason"] == "done":
        return f"walked {result['steps']} steps"
    return f"{result['reason']} after {result['steps']} of {result['steps_requested']} steps"


def _pace(result: Result) -> str:
    """Return the mean speed; "" for a walk too short to have one."""
    speed = result["speed_m_s"]
    return "" if speed is None else f" at {speed:.3f} m/s"


def _flying(result: Result) -> str:
    """Return the number of flight phases, and their share of the time."""
    flights = result.get("flights", 0)
    share = result.get("flight_time_s", 0.0) / result["sim_time_s"]
    return f", {flights} flights ({share:.0%} of the time)" if flights else ""


def _sliding(result: Result) -> str:
    """Return whether slipping was detected, so that the robot walked with care."""
    return ", in the style for slippery ground" if result["slipped"] else ""


def _caught(result: Result) -> str:
    """Return how often the robot was caught by steps."""
    catches = result["catches"]
    steps = sum(catch["steps"] for catch in catches)
    return f", {len(catches)} x caught by steps ({steps})" if catches else ""


def _crossing(result: Result) -> str:
    """Return a warning if the feet interpenetrated."""
    clear = result["foot_clearance_mm"]
    return f", feet cross by {-clear:.0f} mm" if clear is not None and clear < 0.0 else ""
