"""The arrays of a run, with their units and names; saved to a file, loaded from it, and drawn."""

import json
import zipfile
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from windup.hal.errors import UsageError
from windup.hal.joints import Array
from windup.tools.reports.run_picture import draw_run
from windup.tools.terminal.writing import writing

UNITS: Final[dict[str, str]] = {
    "time": "s",
    "position_asked": "rad",
    "position_applied": "rad",
    "position": "rad",
    "velocity": "rad/s",
    "torque": "N m",
    "voltage": "V",
    "temperature": "degrees C",
    "contacts": "N",
    "base_position": "m",
    "base_orientation": "quaternion wxyz, body to world",
    "base_linear_velocity": "m/s in the world frame",
    "base_angular_velocity": "rad/s in the body frame",
    "imu_angular_velocity": "rad/s in the body frame",
    "imu_acceleration": "m/s2 in the body frame",
    "tick_time": "s",
}
"""Unit of each array of a run."""
TEXTS: Final = ("robot", "reason", "units", "joint_names", "contact_names")
"""What a file of a run has beside its arrays."""


@dataclass(frozen=True)
class RunData:
    """The arrays of a run of t ticks, n joints and k contact sensors.

    Attributes:
        robot: Name of the robot.
        reason: Why the run ended.
        joints: Names of the joints, in the order of the columns.
        contacts: Names of the contact sensors, in the order of the columns.
        arrays: Name to array: `time` (t,) from the first tick on; (t, n) `position_asked` by the
            controller, `position_applied` by the joints, `position` measured, `velocity`,
            `torque`, `voltage`, `temperature`; `contacts` (t, k); `base_...` and `imu_...` (t, 3)
            or (t, 4); `tick_time` (t,). NaN where nothing was measured. Units as in `units`.
    """

    robot: str
    reason: str
    joints: tuple[str, ...]
    contacts: tuple[str, ...]
    arrays: Mapping[str, Array]

    @property
    def units(self) -> Mapping[str, str]:
        """Unit of each array."""
        return {name: UNITS[name] for name in self.arrays}

    def save(self, path: str | Path) -> None:
        """Write the arrays and their names into a NumPy file (.npz); `load_run` reads it.

        Raises:
            OutputError: The file cannot be written.
        """
        texts = {
            "robot": self.robot,
            "reason": self.reason,
            "units": json.dumps(dict(self.units)),
            "joint_names": self.joints,
            "contact_names": self.contacts,
        }
        arrays = {name: np.array(text, dtype=np.str_) for name, text in texts.items()}
        with writing(Path(path)), Path(path).open("wb") as file:
            np.savez_compressed(file, **arrays, **self.arrays)  # type: ignore[arg-type]

    def plot(self, path: str | Path) -> None:
        """Draw joints, torque, base and contacts into an image file.

        Raises:
            UsageError: matplotlib is not installed, or the suffix is not that of a picture.
            OutputError: The file cannot be written.
        """
        title = f"{self.robot}: {self.reason}"
        draw_run(Path(path), title, self.joints, self.contacts, self.arrays)


def load_run(path: str | Path) -> RunData:
    """Return a run that `report.save` has written.

    Raises:
        UsageError: There is no such file, or it is not one of a run.
    """
    try:
        with np.load(path, allow_pickle=False) as file:
            found = {name: file[name] for name in file.files}
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror or error}") from None
    except (ValueError, zipfile.BadZipFile, EOFError):
        found = {}
    if missing := {*TEXTS, "time"} - set(found):
        raise UsageError(
            f"{path} is not the file of a run (without {', '.join(sorted(missing))}): "
            "report.save(path) writes one"
        )
    texts = {name: found.pop(name) for name in TEXTS}
    return RunData(
        str(texts["robot"]),
        str(texts["reason"]),
        tuple(texts["joint_names"].tolist()),
        tuple(texts["contact_names"].tolist()),
        {name: found[name] for name in UNITS if name in found},
    )


class Results(ABC):
    """A report of a run that was recorded: its arrays, to be read, saved and drawn."""

    @property
    @abstractmethod
    def data(self) -> RunData:
        """The arrays with the names of their columns.

        Raises:
            UsageError: The run was not recorded.
        """
        ...

    @property
    def arrays(self) -> Mapping[str, Array]:
        """Name to array; see `RunData`.

        Raises:
            UsageError: The run was not recorded.
        """
        return self.data.arrays

    @property
    def units(self) -> Mapping[str, str]:
        """Unit of each array.

        Raises:
            UsageError: The run was not recorded.
        """
        return self.data.units

    def save(self, path: str | Path) -> None:
        """Write the arrays into a NumPy file (.npz), which `windup.load_run` reads.

        Raises:
            UsageError: The run was not recorded.
            OutputError: The file cannot be written.
        """
        self.data.save(path)

    def plot(self, path: str | Path) -> None:
        """Draw joints, torque, base and contacts into an image file.

        Raises:
            UsageError: The run was not recorded, or matplotlib is not installed.
            OutputError: The file cannot be written.
        """
        self.data.plot(path)
