"""Kenwright 2012: one module a group of statements."""

from pathlib import Path

from windup import control, robots, sim_twin
from windup.tools.reproduce.kenwright import (
    comfort,
    falls,
    feet,
    pushes,
    recorder,
    regions,
    steps,
    turning,
    walking,
    work,
)
from windup.tools.reproduce.study.figure import Study, folder_of

KENWRIGHT = Study(
    name="kenwright",
    title="Responsive stepping: Kenwright 2012 again",
    source="B. Kenwright, Responsive Biped Character Stepping: When Push Comes to Shove, "
    "Cyberworlds 2012.",
    setting="The paper's character is a point mass on springs whose skeleton is posed by inverse "
    "kinematics; it prints figures, no numbers. Ours is OP3, 3.2 kg on 20 position servos in "
    "MuJoCo, that knows itself from its sensors, with 10 ms of delay, and starts with 0.2 degrees "
    "of noise on its pose. Pushes last 0.1 s at the trunk. Names of statements are those of the "
    "paper's figures and of its Algorithm V-1. The thresholds are ours.",
    figures=(
        *pushes.FIGURES,
        *feet.FIGURES,
        *steps.FIGURES,
        *comfort.FIGURES,
        *turning.FIGURES,
        *regions.FIGURES,
        *walking.FIGURES,
        *falls.FIGURES,
    ),
    work=work.work,
    sources=(
        folder_of(control),
        folder_of(sim_twin),
        folder_of(robots) / "op3",
        Path(work.__file__),
        Path(recorder.__file__),
        Path(work.__file__).parents[2] / "behaviours" / "push_trial.py",
        Path(work.__file__).parents[2] / "behaviours" / "striding.py",
    ),
    missing={
        "7, 8": "pictures of the paper's skeleton: ours is the model of the robot",
    },
)
