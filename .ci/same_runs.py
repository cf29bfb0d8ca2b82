#!/usr/bin/env python3
"""Do robots still do, digit by digit, what they did? For moving walls without moving a robot.

    .venv/bin/python .ci/same_runs.py .ci/runs            # after each step
    .venv/bin/python .ci/same_runs.py --store .ci/runs    # where a change is meant, and said

Each command's JSON is kept, without times. They are compared on one machine: another processor
may round the last digit differently, so store them anew on yours before you begin.
"""

import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

COMMON = ["--noise", "0.2", "--seeds", "3"]
WIRE = "twin://{}?clock=virtual"
RUNS: dict[str, list[str]] = {
    "walk-op3": ["walk", "op3", "--steps", "20", *COMMON],
    "walk-op3-estimated": ["walk", "op3", "--steps", "20", "--state", "estimated", *COMMON],
    "walk-op3-wire": ["walk", "op3", "--steps", "12", "--port", WIRE.format("op3")],
    "walk-duck": ["walk", "duck", "--steps", "20", *COMMON],
    "walk-duck-wire": ["walk", "duck", "--steps", "12", "--port", WIRE.format("duck")],
    "walk-human": ["walk", "human", "--steps", "12", *COMMON],
    "run-robobird": ["walk", "robobird", "--gait", "run", "--steps", "12", *COMMON],
    "push-op3": ["push", "op3", "--impulse", "1.9", "--direction", "30", *COMMON],
    "push-op3-estimated": [
        *["push", "op3", "--impulse", "1.9", "--direction", "200", "--state", "estimated"],
        *["--delay", "0.01", *COMMON],
    ],
    "push-human": ["push", "human", "--impulse", "40", "--direction", "30", *COMMON],
    "footprints-op3": ["footprints", "op3", "--random", "8", *COMMON],
    "footprints-human": ["footprints", "human", "--random", "4", *COMMON],
    "stride-op3": ["stride", "op3", "--speed", "0.1", "--seconds", "4", *COMMON],
    "play-op3": ["play", "op3", "squat", *COMMON],
    "play-op3-wire": ["play", "op3", "wave", "--port", WIRE.format("op3")],
    "rise-op3": ["rise", "op3", *COMMON],
    "stand-duck-wire": ["stand", "duck", "--seconds", "2", "--port", WIRE.format("duck")],
}
TIMES = {"wall_time_s", "rollout_time_s", "tick_ms", "missed", "late_plans"}
"""Keys that say how fast the machine was."""


def without_times(value: Any) -> Any:
    """Return a result without what depends on the clock of the wall."""
    if isinstance(value, dict):
        return {key: without_times(item) for key, item in value.items() if key not in TIMES}
    if isinstance(value, list):
        return [without_times(item) for item in value]
    return value


def result_of(words: list[str]) -> str:
    """Return the JSON of a command, without times, and its exit status."""
    windup = [sys.executable, "-c", "from windup.tools.cli import main; main()"]
    done = subprocess.run(
        [*windup, *words, "--json", "-"], capture_output=True, text=True, check=False
    )
    try:
        result = without_times(json.loads(done.stdout))
    except ValueError:
        result = done.stderr.splitlines()[-5:]
    return json.dumps([done.returncode, result], indent=1, sort_keys=True) + "\n"


def main(arguments: list[str]) -> int:
    """Store or compare; returns the exit status."""
    store = arguments[:1] == ["--store"]
    if len(arguments) != 1 + store:
        print(__doc__)
        return 2
    folder = Path(arguments[-1])
    folder.mkdir(parents=True, exist_ok=True)
    others = []
    with ThreadPoolExecutor(2) as workers:
        for name, text in zip(RUNS, workers.map(result_of, RUNS.values()), strict=True):
            file = folder / f"{name}.json"
            if store:
                file.write_text(text)
            elif not file.exists() or file.read_text() != text:
                others.append(name)
                file.with_suffix(".now").write_text(text)
            print(f"{name}: {'stored' if store else 'other' if name in others else 'same'}")
    return 1 if others else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
