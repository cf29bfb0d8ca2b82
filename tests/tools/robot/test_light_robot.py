"""What is imported when: little by `from windup import Robot`, and nothing by a first run."""

import subprocess
import sys


def printed(program: str) -> str:
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    return ran.stdout.strip()


def test_robot_is_imported_without_anything_heavy() -> None:
    heavy = {"mujoco", "scipy", "shapely", "daqp", "tyro", "rich", "serial", "multiprocessing"}
    program = f"import sys; from windup import Robot; print(sorted({heavy} & set(sys.modules)))"
    assert printed(program) == "[]"


def test_the_first_run_of_an_armed_robot_imports_nothing_of_weight() -> None:
    program = """
import sys
from windup import Robot
robot = Robot.open("op3", port="twin://op3?clock=virtual")
before = set(sys.modules)
robot.stand(0.1)
robot.walk(steps=1)
for _ in robot.ticks(seconds=0.1):
    pass
late = sorted(set(sys.modules) - before)
print([name for name in late if name.split(".")[0] in {"windup", "mujoco", "scipy", "shapely"}])
"""
    assert printed(program) == "[]"
