import pytest

from tests.tools.conftest import Windup


@pytest.mark.parametrize("graph", ["bow", "look_around", "squat"])
def test_a_duck_plays_its_graphs_over_a_wire_that_drops_answers(shell: Windup, graph: str) -> None:
    line = f"play duck {graph} --port twin://duck --faults drop:0.01 --seconds 3"
    ran = shell(*line.split(), "--json", "-")
    assert (ran.status, ran.json["reason"], ran.json["fell"]) == (0, "done", False)


def test_a_duck_walks_over_the_wire_on_what_its_sensors_say(shell: Windup) -> None:
    line = "walk duck --port twin://duck?clock=virtual --faults drop:0.01 --steps 12 --turn 15"
    ran = shell(*line.split(), "--json", "-")
    assert (ran.status, ran.json["steps"], ran.json["fell"]) == (0, 12, False)
    assert ran.json["heading_deg"] > 5.0
