"""Record a walk, save its arrays, load them again, and draw pictures.

Run it with `python examples/log_and_plot.py`; it writes walk.npz, walk.png and feet.png into the
present folder. Pictures need the extra `plot`: `pip install -e '.[plot]'`.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from windup import Robot, RunData, load_robot, load_run


def record(folder: Path) -> Path:
    """Walk twelve steps; return the file of the walk."""
    with Robot.open("op3", record=True) as robot:
        report = robot.walk(speed=0.15, steps=12)
    print(report)
    report.plot(folder / "walk.png")
    report.save(folder / "walk.npz")
    return folder / "walk.npz"


def draw_feet(run: RunData, path: Path) -> None:
    """Draw the knees, in degrees, and the force on each foot, in N."""
    figure, (angles, forces) = plt.subplots(2, sharex=True, layout="constrained")
    time = run.arrays["time"]
    for name in ("l_knee", "r_knee"):
        knee = run.arrays["position"][:, run.joints.index(name)]
        angles.plot(time, np.degrees(knee), label=name)
    angles.set_ylabel("degrees")
    for foot, sensors in load_robot(run.robot).contacts.feet.items():
        columns = [run.contacts.index(sensor) for sensor in sensors]
        forces.plot(time, run.arrays["contacts"][:, columns].sum(axis=1), label=foot)
    forces.set(xlabel=f"time [{run.units['time']}]", ylabel=run.units["contacts"])
    for axes in (angles, forces):
        axes.legend()
    figure.savefig(path)
    plt.close(figure)


def main(folder: Path = Path()) -> RunData:
    """Write the file and the pictures into `folder`; return the run as it was loaded."""
    run = load_run(record(folder))
    draw_feet(run, folder / "feet.png")
    return run


if __name__ == "__main__":
    main()
