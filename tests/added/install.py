"""Installs a package of somebody else: its files and its metadata in a folder on `sys.path`."""

from collections.abc import Mapping
from pathlib import Path
from textwrap import dedent

Groups = Mapping[str, Mapping[str, str]]


def install(
    folder: Path, name: str, groups: Groups | str, modules: Mapping[str, str] | None = None
) -> None:
    """Write the distribution `name` 1.0 into a folder.

    Args:
        folder: The folder.
        name: Name of the distribution.
        groups: Entry points by group and name, or the text of entry_points.txt.
        modules: Texts of its modules by name.
    """
    metadata = folder / f"{name.replace('-', '_')}-1.0.dist-info"
    metadata.mkdir(parents=True)
    (metadata / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(
        groups if isinstance(groups, str) else "".join(map(_section, groups, groups.values()))
    )
    for module, text in (modules or {}).items():
        (folder / f"{module}.py").write_text(dedent(text))


def _section(group: str, entries: Mapping[str, str]) -> str:
    return f"[{group}]\n" + "".join(f"{name} = {value}\n" for name, value in entries.items())
