"""How the house is built: no circles, no crowded folders, no long files."""

import ast
from collections import defaultdict
from collections.abc import Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from statistics import median

import pytest

ROOT = Path(__file__).parent.parent
ROOMS = ("hal", "control", "robots", "sim_twin", "tools")
MOST_FILES, MOST_LINES, USUAL = 20, 300, 120
Graph = Mapping[str, set[str]]


def files(*folders: str) -> list[Path]:
    return [path for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))]


def name_of(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(("windup", *parts)).removesuffix(".__init__")


MODULES = {name_of(path): path for path in files(*ROOMS)}


def imported(path: Path) -> Iterator[str]:
    """Yield our modules that a file imports anywhere, also for types alone."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in MODULES)
        elif isinstance(node, ast.ImportFrom) and node.module in MODULES:
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                yield whole if whole in MODULES else node.module


IMPORTS: Graph = {
    name: {other for other in imported(path) if other != name} for name, path in MODULES.items()
}


def circle(graph: Graph) -> list[str]:
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def within(folder: str) -> Graph:
    """Return which part of a folder imports which: its folders, and its own files together."""

    def part(module: str) -> str:
        rest = module.removeprefix(f"{folder}.").split(".")
        is_file = len(rest) == 1 and MODULES[module].name != "__init__.py"
        return "its own files" if is_file else rest[0]

    graph: dict[str, set[str]] = defaultdict(set)
    for name, others in IMPORTS.items():
        if name.startswith(f"{folder}.") and MODULES[name].name != "__init__.py":
            inside = {part(other) for other in others if other.startswith(f"{folder}.")}
            graph[part(name)] |= inside - {part(name)}
    return graph


def test_no_file_imports_itself_in_a_circle() -> None:
    assert circle(IMPORTS) == []


@pytest.mark.parametrize(
    "folder", sorted({name for name, path in MODULES.items() if path.name == "__init__.py"})
)
def test_no_folder_inside_a_folder_imports_itself_in_a_circle(folder: str) -> None:
    assert circle(within(folder)) == []


def test_a_circle_is_seen() -> None:
    assert circle({"a": {"b"}, "b": {"c"}, "c": {"a"}}) != []


def test_no_folder_is_crowded() -> None:
    count: dict[Path, int] = defaultdict(int)
    for path in files(*ROOMS, "tests"):
        count[path.parent.relative_to(ROOT)] += 1
    assert {folder: number for folder, number in count.items() if number > MOST_FILES} == {}


def test_files_are_short() -> None:
    lines = {path: len(path.read_text().splitlines()) for path in files(*ROOMS, "tests")}
    assert [str(path) for path, number in lines.items() if number > MOST_LINES] == []
    assert median(lines.values()) <= USUAL


def test_every_folder_says_what_it_is() -> None:
    silent = [
        name for name in MODULES if not ast.get_docstring(ast.parse(MODULES[name].read_text()))
    ]
    assert silent == []
