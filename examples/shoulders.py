"""Swing the shoulders along a sine: a plain `for` loop over the ticks of the control loop.

Run it with `python examples/shoulders.py`. The same loop runs through emulated servos and on the
robot: `main("twin://op3")`, or `Robot.open("op3", port="/dev/ttyUSB0", arm=True)` below.
"""

import numpy as np

from windup import JointCommand, Robot, RunReport

AMPLITUDE = 0.4
"""Of the shoulders, rad."""
PERIOD = 2.0
"""Of one swing to the front and back, s."""


def main(port: str | None = None) -> RunReport:
    """Swing for two periods; return the report of the loop, with its arrays."""
    with Robot.open("op3", port=port, record=True) as robot:
        robot.stand(1.0)
        forward = robot.joints.array({"l_sho_pitch": 1.0, "r_sho_pitch": -1.0})
        start = robot.read().time
        ticks = robot.ticks(seconds=2 * PERIOD)
        for observation in ticks:
            phase = 2.0 * np.pi * (observation.time - start) / PERIOD
            goal = robot.description.stance + AMPLITUDE * np.sin(phase) * forward
            robot.write(JointCommand.of(robot.joints, position=goal))
        report = ticks.report
    left = report.arrays["position"][:, report.data.joints.index("l_sho_pitch")]
    print(f"{report.reason} after {report.ticks} ticks; fallen: {report.fallen}")
    print(f"the left shoulder went through {np.degrees(np.ptp(left)):.0f} degrees")
    return report


if __name__ == "__main__":
    main()
