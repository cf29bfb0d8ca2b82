"""Names, records and paths of the schemas."""

from pathlib import Path
from typing import Any, Final

from windup.control.footprints.directed_file import Directed, ServoDirected
from windup.control.footprints.footprints import FootprintFile
from windup.control.pose_graph.gait_file import GaitFile
from windup.control.stepping.stepping_file import Stepping
from windup.control.stride.stride_file import Stride
from windup.control.whole_body.whole_body_file import WholeBodyFile
from windup.robots.records import RobotFile

FOLDER: Final = Path(__file__).parent
SUFFIX: Final = ".schema.json"
RECORDS: Final[dict[str, type[Any]]] = {
    "robot": RobotFile,
    "gait": GaitFile,
    "stepping": Stepping,
    "stride": Stride,
    "whole_body": WholeBodyFile,
    "footprint_gains_servo": ServoDirected,
    "footprint_gains_torque": Directed,
    "footprint_list": FootprintFile,
}
"""Name of a schema, and the record of its files.

`robot` is robot.toml, `gait` a file of gaits/; `stepping`, `stride` and `whole_body` are the files
of these names beside robot.toml. `footprint_gains_servo` and `footprint_gains_torque` are
footprints.toml beside it, by the kind of its drive; `footprint_list` is what
`windup footprints ROBOT FILE` walks.
"""


def schema_path(name: str) -> Path:
    """Return the path of a schema by its name in `RECORDS`."""
    return FOLDER / f"{name}{SUFFIX}"


def schema_line(name: str) -> str:
    """Return the comment line that tells editors the schema of a TOML file.

    Taplo, Even Better TOML and Tombi read it in the first line.
    """
    return f"#:schema {schema_path(name).resolve().as_uri()}"
