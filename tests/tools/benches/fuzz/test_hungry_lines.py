"""What asks for more than a machine has: refused, before it is read or made."""

import subprocess
import sys
from pathlib import Path

HUNGRY = [
    "walk op3 --path /dev/zero",
    "footprints op3 /dev/zero",
    "walk op3 --seeds 1000000000",
    "walk op3 --gait /dev/zero",
    "walk op3 --learn /dev/zero",
    "scan twin://bench?servos=XM430-W350:1-1000000000",
    "scan twin://op3?latency=nan",
    "emulate twin://bench?servos=XM430-W350:1-1000000000 --tcp 0",
    "sweep walk op3 --grid speed=0:1:1000000000 --out a.csv",
    "sweep walk op3 --grid speed=0:1:9999 --grid side=0:1:9999 --seeds 99999 --out a.csv",
    "sweep walk op3 --out /dev/zero",
    "stand op3 --seconds 1e300",
    "walk op3 --steps 1000000000",
]
PROGRAM = """
import resource, sys
from windup.tools import cli
resource.setrlimit(resource.RLIMIT_DATA, (2**30, 2**30))
print([cli.run(line.split()) for line in sys.argv[1:]])
"""


def test_nothing_is_read_or_made_past_a_gigabyte(tmp_path: Path) -> None:
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM, *HUNGRY],
        cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert run.stdout.strip() == str([2] * len(HUNGRY)), run.stderr
    assert run.stderr.count("windup: ") == len(HUNGRY)
