"""The one runner of behaviours: seeds, rows, hooks, Ctrl-C."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import ClassVar

import pytest

from tests.tools.conftest import Windup, refusal
from windup import Robot
from windup.tools import cli
from windup.tools.behaviours.run_record import RunRecord
from windup.tools.behaviours.stand import Stand as StandBehaviour
from windup.tools.behaviours.stand import StandOptions
from windup.tools.commands.behaviour_command import Hook
from windup.tools.commands.stand import Stand


class StopsAfterwards(StandBehaviour):
    """Is interrupted between a run that went well and the next one."""

    def perform(self, run: RunRecord[StandOptions]) -> None:
        super().perform(run)
        raise KeyboardInterrupt


@dataclass(frozen=True, kw_only=True)
class Interrupted(Stand):
    behaviour = StopsAfterwards()


@dataclass(frozen=True, kw_only=True)
class Logged(Stand):
    """Counts the observations of each run."""

    counts: ClassVar[list[int]] = []

    def hooks(self) -> Sequence[Hook]:
        return [self._count]

    @contextmanager
    def _count(self, robot: Robot) -> Iterator[None]:
        seen: list[float] = []
        robot.watch.append(lambda observation: seen.append(observation.time))
        yield
        self.counts.append(len(seen))


def test_a_hook_is_entered_for_every_run() -> None:
    assert Logged(robot="op3", seconds=0.2, seeds=2).run() == 0
    assert len(Logged.counts) == 2 and min(Logged.counts) > 20


def test_an_interruption_between_two_runs_of_the_loop_is_one() -> None:
    report = Interrupted(robot="op3", seconds=0.1).one(0)
    assert (report.good, report.reason) == (False, "interrupted")
    assert report.result["reason"] == "interrupted"
    assert Interrupted(robot="op3", seconds=0.1, seeds=3).run() == 130


def test_walks_of_several_seeds_are_rows_in_their_order(shell: Windup) -> None:
    line = ["walk", "op3", "--open-loop", "--steps", "2", "--seeds", "3", "--noise", "0.2"]
    ran = shell(*line, "--json", "-")
    assert ran.status == 0, ran.err
    assert [row["seed"] for row in ran.json["rows"]] == [0, 1, 2]
    assert {"warnings", "driver_clamps"} <= set(ran.json["rows"][0])
    assert ran.json["summary"]["walked"] == 3
    assert "3 of 3 runs walked to the end" in ran.err


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("walk op3 --way ip", "--way ip is how steps catch a walk: give --catch, too"),
        ("walk duck --catch", "duck"),
        ("push op3 --envelope --during walk", "leave --during walk away"),
        ("footprints op3", "give a FILE of footprints, or --random N"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(line: str, said: str) -> None:
    assert said in refusal(line.split())


def test_a_motion_without_arm_is_refused_before_the_port_is_opened(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert cli.run(["stand", "op3", "--port", "/dev/no_such_port"]) == 2
    assert "this moves a robot: give --arm" in capsys.readouterr().err
