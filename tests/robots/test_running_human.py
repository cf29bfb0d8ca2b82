"""The human's run: a flight in every step, and a gait that its walk can be blended with."""

from itertools import pairwise

from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.robot.robot import Robot


def test_it_runs_with_a_flight_in_every_step_and_does_not_hop() -> None:
    with Robot.open("human", noise=0.2) as robot:
        result = robot.walk(steps=20, options=WalkOptions(gait="run")).result()
    assert result["reason"] == "done"
    assert result["flights"] >= 19
    assert result["flight_time_s"] > 0.3 * result["sim_time_s"]
    assert result["skips"] < 0.3, "the feet take turns"
    assert result["distance_m"] > 2.0


def test_its_walk_takes_a_share_of_the_run() -> None:
    with Robot.open("human", noise=0.2) as robot:
        options = WalkOptions(blend=("run=0.3@0.5",))
        report = robot.walk(steps=16, options=options)
    assert report.done
    walker = report.walker
    share = [record.scale[walker.gait.index("blend run")] for record in walker.records]
    assert share[0] == 0.0
    assert max(share) > 0.25
    assert all(0.0 <= after - before < 0.06 for before, after in pairwise(share))
