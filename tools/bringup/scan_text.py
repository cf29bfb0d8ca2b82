"""Formats the result of a scan for the width of the terminal."""

from collections.abc import Iterator
from typing import Any, Final

from rich.table import Table

from windup.hal.servo_bus.wiring import PROTOCOL_1
from windup.tools.bringup.raw_answers import InvalidAnswer
from windup.tools.bringup.survey import Survey

WIDE: Final = 78
"""Width of a terminal that the whole table needs, columns."""
HEADS: Final = {
    "id": "id",
    "model": "model",
    "firmware": "firmware",
    "baud": "baud",
    "voltage_v": "V",
    "temperature_c": "deg C",
    "error": "error",
    "joint": "joint",
}
"""Heads of the columns by the keys of a row."""
LONG: Final = ("firmware", "baud", "error")
"""Columns omitted on a narrow terminal; baud rates and errors have lines of their own there."""
SHOWN: Final = 8
"""Number of bytes of an answer that are shown."""


def table(rows: list[dict[str, Any]], width: int) -> Table:
    """Return the table of the servos for a terminal of `width` columns."""
    keys = [key for key in HEADS if width >= WIDE or key not in LONG]
    keys = [key for key in keys if any(row[key] not in (None, "") for row in rows)]
    made = Table(box=None, padding=(0, 2 if width >= WIDE else 1, 0, 0))
    for key in keys:
        made.add_column(HEADS[key], overflow="fold")
    for row in rows:
        made.add_row(*("-" if row[key] is None else str(row[key]) for key in keys))
    return made


def narrow_lines(rows: list[dict[str, Any]], width: int) -> Iterator[str]:
    """Yield the important values that the table of a narrow terminal omits."""
    if width < WIDE:
        for baud in dict.fromkeys(row["baud"] for row in rows):
            if baud is not None:
                yield f"at {baud} baud"
        yield from (f"id {row['id']}: {row['error']}" for row in rows if row["error"])


def problems_found(survey: Survey, url: str, missing: list[str]) -> Iterator[str]:
    """Yield a line for each problem found."""
    for one in survey.unknown:
        numbers = " or ".join(f"{number} ({family})" for family, number in one["numbers"].items())
        at = "" if one["baud"] is None else f" at {one['baud']} baud"
        yield f"id {one['id']}{at}: unknown model {numbers}; no supported servo has this number"
    for one in survey.protocol_1:
        at = "" if one["baud"] is None else f" at {one['baud']} baud"
        yield f"id {one['id']}{at}: {one['model']} {PROTOCOL_1}"
    if survey.duplicate_ids:
        ids = ", ".join(map(str, survey.duplicate_ids))
        yield (
            f"id {ids}: only corrupt answers: are there two servos with this id? "
            "Connect one of them alone and change its id"
        )
    if survey.echo:
        yield f"{url} echoes all bytes sent: switch the echo of the adapter off"
    elif invalid := [one for _, _, one in survey.invalid if one.whole or one.id is None]:
        yield (
            f"something answers on {url} with frames that no supported servo sends "
            f"(first bytes {_hex(invalid[0])})"
        )
    if missing:
        yield f"silent: {', '.join(missing)}"
    if not (survey.servos or survey.unknown or survey.protocol_1 or survey.invalid or survey.echo):
        yield f"no servo answers on {url}: is the servo power on, and this the right port?"


def _hex(invalid: InvalidAnswer) -> str:
    return f"{invalid.data[:SHOWN].hex(' ')}{' ..' if len(invalid.data) > SHOWN else ''}"
