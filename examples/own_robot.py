"""A robot of your own: examples/biped is a folder with twelve joints, described from scratch.

Run it with `python examples/own_robot.py`. The page "Your own robot" of the documentation goes
through its files; replace them by yours.
"""

from pathlib import Path

from windup import Robot, load_robot
from windup.robots.inspection.robot_warnings import robot_warnings

FOLDER = Path(__file__).parent / "biped"


def main(steps: int = 40) -> tuple[bool, float | None]:
    """Check the folder, stand, walk; return whether it still stands, and its speed, m/s."""
    description = load_robot(FOLDER)
    mass = description.spec().compile().body_subtreemass[0]
    print(f"{description.title}: {len(description.joints)} joints, {mass:.2f} kg")
    for warning in robot_warnings(description):
        print(f"doubtful: {warning}")

    with Robot.open(str(FOLDER)) as robot:
        robot.stand(2.0)
        print(f"stands: {not robot.fallen}")

    with Robot.open(str(FOLDER)) as robot:
        report = robot.walk(speed=0.1, steps=steps)
        print(report)
        return not robot.fallen, report.speed


if __name__ == "__main__":
    main()
