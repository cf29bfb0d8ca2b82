import pytest

from tests.tools.conftest import Windup
from windup.hal.errors import UsageError
from windup.sim_twin.environment import Environment
from windup.sim_twin.ground.terrain import Ground
from windup.tools.robot.robot import Robot


def test_a_random_plant_walks_through_the_wire(shell: Windup) -> None:
    line = "walk op3 --port twin://op3 --plant 3 --speed 0.15 --steps 6 --json -"
    ran = shell(*line.split())
    assert (ran.status, ran.json["fell"], ran.json["steps"]) == (0, False, 6)


@pytest.mark.parametrize(
    ("port", "message"),
    [
        ("socket://localhost:1", "only a twin has another ground or plant; leave --port away"),
        ("twin://op3?world=ours", "world 'ours' may be others' too; leave world= away"),
    ],
)
def test_a_ground_where_none_can_be_is_refused(port: str, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        Robot.open("op3", port=port, world=Environment(Ground(slope=2.0)))
