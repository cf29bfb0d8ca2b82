"""Log a walk into arrays, save them, and draw a picture.

Run it with `python examples/log_and_plot.py`; it writes walk.npz and walk_log.png into the present
folder. The picture needs the extra `plot`: `pip install -e '.[plot]'`.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from windup import Observation, Robot


class Log:
    """Keeps what is measured at every tick."""

    def __init__(self) -> None:
        self.rows: dict[str, list[np.ndarray]] = {"time": [], "position": [], "contacts": []}

    def __call__(self, observation: Observation) -> None:
        """Add an observation: s, rad, N."""
        self.rows["time"].append(np.array(observation.time))
        self.rows["position"].append(observation.joints.position.copy())
        self.rows["contacts"].append(observation.contacts.copy())

    def arrays(self) -> dict[str, np.ndarray]:
        """Return time (t,), position (t, n) and contacts (t, k)."""
        return {name: np.array(rows) for name, rows in self.rows.items()}


def main(folder: Path = Path()) -> dict[str, np.ndarray]:
    """Walk twelve steps, write the log and the picture into `folder`, and return the arrays."""
    log = Log()
    with Robot.open("op3") as robot:
        robot.watch.append(log)
        print(robot.walk(speed=0.15, steps=12))
        names = robot.description.joints.names
        feet = robot.description.contacts
    arrays = log.arrays()
    np.savez(folder / "walk.npz", **arrays)
    figure, (angles, forces) = plt.subplots(2, sharex=True, layout="constrained")
    for name in ("l_knee", "r_knee"):
        knee = np.degrees(arrays["position"][:, names.index(name)])
        angles.plot(arrays["time"], knee, label=name)
    angles.set_ylabel("degrees")
    for foot, sensors in feet.feet.items():
        columns = [feet.names.index(sensor) for sensor in sensors]
        forces.plot(arrays["time"], arrays["contacts"][:, columns].sum(axis=1), label=foot)
    forces.set(xlabel="s", ylabel="N")
    for axes in (angles, forces):
        axes.legend()
    figure.savefig(folder / "walk_log.png")
    plt.close(figure)
    return arrays


if __name__ == "__main__":
    main()
