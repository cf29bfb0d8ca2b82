import pytest

from tests.tools.conftest import Windup


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("stand duck --faults drop:0.01", "--faults needs a twin:// port, there is no --port"),
        ("play duck bow --port /dev/ttyUSB0 --faults drop", "there is --port /dev/ttyUSB0"),
        ("stop duck --port socket://a:1 --faults drop", "there is --port socket://a:1"),
        ("scan /dev/ttyUSB0 --faults drop", "there is --port /dev/ttyUSB0"),
        ("health duck --faults drop", "there is no --port"),
        ("walk duck --port twin://duck --faults dorp", "did you mean 'drop'?"),
        ("stand duck --port twin://duck --faults drop:2", "rate 2: give 0 .. 1"),
        ("stand duck --port twin://duck?faults=drop --faults cut", "has faults already"),
    ],
)
def test_faults_that_cannot_be_are_status_2(shell: Windup, line: str, message: str) -> None:
    ran = shell(*line.split(), "--json", "-")
    assert ran.status == 2
    assert message in ran.json["error"]["message"]


def test_a_stand_loses_answers_and_goes_on(shell: Windup) -> None:
    line = "stand duck --port twin://duck --seconds 1.5 --faults drop:0.05,unplug:at=99"
    ran = shell(*line.split(), "--json", "-")
    assert (ran.status, ran.json["reason"], ran.json["fell"]) == (0, "done", False)


def test_a_scan_misses_the_dead(shell: Windup) -> None:
    url = "twin://bench?servos=STS3215:1-2"
    ran = shell("scan", url, "--baud", 1_000_000, "--faults", "dead:at=0:ids=2", "--json", "-")
    assert [row["id"] for row in ran.json["servos"]] == [1]


def test_a_dead_servo_is_not_known_to_be_limp(shell: Windup) -> None:
    line = "stop duck --port twin://duck --faults dead:at=0:ids=12"
    ran = shell(*line.split(), "--json", "-")
    assert (ran.status, ran.json["still_on"]) == (3, [])
    assert ran.json["unknown"] == ["right_hip_pitch"]


def test_health_looks_where_the_faulty_run_was(shell: Windup) -> None:
    where = ["duck", "--port", "twin://duck", "--faults", "drop:0.001"]
    assert shell("stand", *where, "--seconds", 1.2).status == 0
    assert shell("health", *where, "--json", "-").status in (0, 1)
    assert shell("health", *where[:-1], "drop:0.002", "--json", "-").status == 2
