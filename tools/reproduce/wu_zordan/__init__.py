"""Wu & Zordan 2010: one module a group of statements."""

from pathlib import Path

from windup import control, robots, sim_twin
from windup.tools.reproduce.study.figure import Study, folder_of
from windup.tools.reproduce.wu_zordan import directed, pendulum, reactive, work

WU_ZORDAN = Study(
    name="wu-zordan",
    title="Goal-directed stepping with momentum control: Wu & Zordan 2010 again",
    source="C.-C. Wu and V. Zordan, Goal-Directed Stepping with Momentum Control, Symposium on "
    "Computer Animation, 2010.",
    setting="The paper prints few numbers and no size of its character. Ours is the human of "
    "Laszlo 1996, 88 kg, with at most 300 N m at a joint, in MuJoCo; the optimisation runs at "
    "200 Hz and inverse dynamics at every step of 1 ms. Dampings are the paper's, scaled by "
    "sqrt(g / c_z) where it is not 3.13 1/s. Pushes last 0.1 s at the trunk. A run survives when "
    "only feet touched the ground and it stands still 3 s after the last push. Names of the groups "
    "are those of the paper's figures and sections.",
    figures=(*directed.FIGURES, *reactive.FIGURES, *pendulum.FIGURES),
    work=work.work,
    sources=(
        folder_of(control),
        folder_of(sim_twin),
        folder_of(robots) / "human",
        folder_of(robots) / "human_handstand",
        Path(work.__file__),
        Path(work.__file__).parents[2] / "behaviours" / "push_trial.py",
        Path(work.__file__).parents[2] / "behaviours" / "directed.py",
    ),
    missing={
        "2, 3": "curves of the model itself: ours are control/execution/swing.py",
    },
)
