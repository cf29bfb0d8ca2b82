from typing import Any

from tests.small_world import observation
from windup.control.loop import LoopReport
from windup.tools.robot.run_end import RunEnd
from windup.tools.robot.stopping import INTERRUPTED, LAY
from windup.tools.stopping.interrupts import StopRequests


class Way:
    """A first motion, or a fall, of which the test says how far it is."""

    def __init__(self, active: bool = True, finished: bool = False) -> None:
        self.active, self.finished = active, finished


def ending(fallen: bool = False, **options: Any) -> RunEnd:
    loop = options.pop("loop", LoopReport())
    return RunEnd(
        asked=options.pop("asked", StopRequests()),
        wishes=options.pop("wishes", []),
        fallen=lambda: fallen,
        loop=loop,
        opened=10.0,
        **options,
    )


def test_a_run_is_done_when_its_time_is_over() -> None:
    end = ending(seconds=2.0)
    assert end(observation(11.9)) is None
    assert end(observation(12.0)) == "done"


def test_its_time_counts_from_the_end_of_the_first_motion() -> None:
    approach, loop = Way(), LoopReport()
    end = ending(seconds=2.0, approach=approach, loop=loop)
    assert end(observation(13.0)) is None
    assert loop.first_motion == 3.0
    approach.active = False
    assert end(observation(14.9)) is None
    assert end(observation(15.0)) == "done"


def test_the_first_motion_counts_from_the_beginning_of_the_loop_on() -> None:
    loop = LoopReport()
    end = ending(seconds=2.0, approach=Way(), loop=loop)
    end.open_at(12.0)
    assert end(observation(13.0)) is None
    assert loop.first_motion == 1.0


def test_whoever_asks_for_the_end_comes_before_everything_else() -> None:
    asked, said = StopRequests(), [""]
    end = ending(fallen=True, asked=asked, wishes=[lambda: None, lambda: said[0]], down=True)
    assert end(observation(10.0)) is None
    said[0] = "the user button"
    assert end(observation(10.1)) == INTERRUPTED
    assert asked.by == "the user button"


def test_a_fall_ends_a_run_unless_the_robot_may_lie() -> None:
    assert ending(fallen=True)(observation(10.0)) == LAY
    assert ending(fallen=True, loop=LoopReport(ticks=3))(observation(10.0)) == "fell"
    assert ending(fallen=True, down=True)(observation(10.0)) is None


def test_a_fall_that_is_softened_goes_on_until_the_robot_lies_still() -> None:
    fall = Way()
    end = ending(fallen=True, seconds=0.0, protected=fall)
    assert end(observation(20.0)) is None
    fall.finished = True
    assert end(observation(20.1)) == "fell"
    stood = ending(protected=Way(finished=True))(observation(20.0))
    assert stood == "fall protection triggered, but the robot did not fall"


def test_a_callers_reason_ends_it() -> None:
    end = ending(seconds=9.0, until=lambda seen: "there" if seen.time > 11.0 else None)
    assert end(observation(10.5)) is None
    assert end(observation(11.5)) == "there"
