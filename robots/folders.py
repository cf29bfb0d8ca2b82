"""The folders of the robots that come with Windup."""

from pathlib import Path

FOLDER = Path(__file__).parent
FILE = "robot.toml"


def robot_names() -> tuple[str, ...]:
    """Return the names of the robots that come with Windup.

    >>> {"human", "op3"} <= set(robot_names())
    True
    """
    return tuple(sorted(path.parent.name for path in FOLDER.glob(f"*/{FILE}")))


def gait_files(folder: Path) -> dict[str, Path]:
    """Return the paths of the gait files in a robot's folder by name."""
    return {path.stem: path for path in sorted((folder / "gaits").glob("*.toml"))}
