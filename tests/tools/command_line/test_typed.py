from dataclasses import dataclass
from pathlib import Path

from windup.tools.command_line.typed import as_typed


@dataclass
class Walk:
    robot: str
    speed: float | None = None
    torso_servo: bool = True
    catch: bool = False
    rv: tuple[str, ...] | None = None
    json: Path | None = None


def test_a_command_is_written_with_what_is_not_at_its_default() -> None:
    command = Walk("op3", speed=0.1, torso_servo=False, catch=True, rv=("up", "a b"))
    assert as_typed(command) == "windup walk op3 --speed 0.1 --no-torso-servo --catch --rv up 'a b'"


def test_what_is_to_be_left_out_is() -> None:
    assert as_typed(Walk("op3", json=Path("-")), ("json",)) == "windup walk op3"
