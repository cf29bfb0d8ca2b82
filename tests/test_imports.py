import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
MAY_IMPORT = {
    "hal": set[str](),
    "control": {"hal"},
    "robots": {"hal"},
    "sim_twin": {"hal", "robots"},
    "tools": {"hal", "control", "robots", "sim_twin"},
}
COMMAND_LINE = {"argparse", "tyro", "rich", "click", "readline", "curses"}
PICTURES = {"matplotlib", "plotly", "viser", "mujoco.viewer", "foxglove", "mcap"}
WIRE = {"serial", "smbus2", "dynamixel_sdk", "scservo_sdk", "rustypot", "socket", "pty"}
MAY_NOT_IMPORT = {
    "hal": COMMAND_LINE | PICTURES | {"mujoco"},
    "control": COMMAND_LINE | PICTURES | WIRE,
    "robots": COMMAND_LINE | PICTURES | WIRE,
    "sim_twin": COMMAND_LINE | PICTURES,
    "tools": set[str](),
}


def imported(tree: ast.AST) -> Iterator[str]:
    """Yield every module that is imported anywhere in a file, with its dotted name."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def printed(tree: ast.AST) -> Iterator[int]:
    """Yield the lines that call `print` or `input`."""
    for node in ast.walk(tree):
        called = node.func if isinstance(node, ast.Call) else None
        if isinstance(called, ast.Name) and called.id in ("print", "input"):
            yield called.lineno


def names(module: str, family: set[str]) -> bool:
    return any(module == name or module.startswith(f"{name}.") for name in family)


def files(room: str) -> list[Path]:
    found = sorted((ROOT / room).rglob("*.py"))
    assert found, f"no files in {room}"
    return found


def parse(path: Path) -> ast.AST:
    return ast.parse(path.read_text(encoding="utf-8"), str(path))


@pytest.mark.parametrize("room", MAY_IMPORT)
def test_a_room_imports_only_the_rooms_it_may(room: str) -> None:
    closed = {f"windup.{other}" for other in set(MAY_IMPORT) - MAY_IMPORT[room] - {room}}
    found = {
        f"{path.relative_to(ROOT)}: {module}"
        for path in files(room)
        for module in imported(parse(path))
        if names(module, closed | {"tests"})
    }
    assert found == set()


@pytest.mark.parametrize("room", [*MAY_IMPORT, "tests"])
def test_rooms_are_imported_by_the_one_name_of_the_package(room: str) -> None:
    found = {
        f"{path.relative_to(ROOT)}: {module}"
        for path in files(room)
        for module in imported(parse(path))
        if names(module, set(MAY_IMPORT))
    }
    assert found == set()


@pytest.mark.parametrize("room", MAY_NOT_IMPORT)
def test_a_room_needs_no_library_that_belongs_elsewhere(room: str) -> None:
    found = {
        f"{path.relative_to(ROOT)}: {module}"
        for path in files(room)
        for module in imported(parse(path))
        if names(module, MAY_NOT_IMPORT[room])
    }
    assert found == set()


@pytest.mark.parametrize("room", ["hal", "control", "robots", "sim_twin"])
def test_only_tools_talk_to_people(room: str) -> None:
    found = [f"{path.name}:{line}" for path in files(room) for line in printed(parse(path))]
    assert found == []


@pytest.mark.parametrize(
    "source",
    [
        "import windup.sim_twin.twin",
        "from windup.sim_twin import twin",
        "from windup.sim_twin.twin import Twin",
        "def late():\n    import windup.sim_twin",
        "if TYPE_CHECKING:\n    from windup.sim_twin.twin import Twin",
    ],
)
def test_the_rule_sees_every_way_to_import(source: str) -> None:
    assert any(names(module, {"windup.sim_twin"}) for module in imported(ast.parse(source)))


def test_the_rule_sees_a_print() -> None:
    assert list(printed(ast.parse("x = 1\nprint(x)"))) == [2]
    assert not names("serialize", {"serial"})
