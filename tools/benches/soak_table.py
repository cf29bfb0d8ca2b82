"""The table of `windup bench faults`: numbers of wrong readings that were reported as fresh."""

from typing import Any

from rich.table import Table

from windup.tools.benches.soak_rig import FAMILIES
from windup.tools.benches.soak_verdict import KINDS


def fault_table(cells: list[dict[str, Any]]) -> Table:
    """Return the wrong readings reported as fresh: one row per fault, one column per servo."""
    table = Table("fault", *FAMILIES.values(), box=None)
    for kind in KINDS:
        row = [[cell for cell in cells if (cell["family"], cell["kind"]) == (family, kind)]
               for family in FAMILIES]  # fmt: skip
        table.add_row(kind, *map(_text, row))
    return table


def _text(cells: list[dict[str, Any]]) -> str:
    """Return the number of wrong readings of some cells, and the expected maximum if not 0."""
    wrong = sum(cell["wrong_and_fresh"] for cell in cells)
    most = sum(cell["expected_at_most"] for cell in cells)
    text = f"{wrong} (<= {most:.0f})" if most else str(wrong)
    return text if all(cell["met"] for cell in cells) else f"{text} NOT MET"
