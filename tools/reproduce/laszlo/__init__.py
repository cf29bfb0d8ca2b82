"""Laszlo 1996, chapters 3 to 5: one module a group of figures."""

from pathlib import Path

from windup import control, robots, sim_twin
from windup.tools.reproduce.laszlo import (
    discrete,
    following,
    open_loop,
    phase,
    ranges,
    responses,
    running,
    speed,
    stance_com,
    step_length,
    stride_rate,
    styles,
    tours,
    turning,
    work,
)
from windup.tools.reproduce.study.figure import Study, folder_of

LASZLO = Study(
    name="laszlo",
    title="Limit-cycle walking: Laszlo 1996 again",
    source="J. Laszlo, Controlling Bipedal Locomotion for Computer Animation, University of "
    "Toronto, 1996, chapters 3 to 5.",
    setting="The thesis' human of 19 joints on its base graph (appendix C), balanced as the thesis "
    "does it: stance hip pitch and roll once a step, two samples each. No heading is held, as in "
    "the thesis. Unlike there, every run begins with 0.2 degrees of noise on the start pose, "
    "and ranges come from several seeds. Turns are by the gait's own turning perturbation, which "
    "may differ from the thesis' (Fig. 5.5). Running, following, stride rates and styles (3.9, "
    "4.18, 5.10 on) are shown by this project's own control, as `windup walk` has it.",
    figures=(
        *running.FIGURES[:1],
        *open_loop.FIGURES,
        *responses.FIGURES,
        *phase.FIGURES,
        *ranges.FIGURES,
        *discrete.FIGURES,
        *step_length.FIGURES,
        *stance_com.FIGURES,
        *speed.FIGURES,
        *turning.FIGURES,
        *following.FIGURES,
        *stride_rate.FIGURES,
        *styles.FIGURES,
        *running.FIGURES[1:],
    ),
    work=work.work,
    sources=(
        folder_of(control),
        folder_of(sim_twin),
        folder_of(robots) / "human",
        folder_of(robots) / "robobird",
        Path(work.__file__),
        Path(tours.__file__),
        Path(work.__file__).with_name("recorder.py"),
        Path(work.__file__).with_name("laws.py"),
    ),
    missing={
        "4.17, 5.12, 5.15, 5.17, 5.19": "tables of graphs and perturbations: ours are the files in "
        "robots/*/gaits/",
    },
)
