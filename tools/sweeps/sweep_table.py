"""The file of a sweep: rows as CSV or Parquet, which survive Ctrl-C."""

import csv
import io
import os
from os import replace
from pathlib import Path
from time import monotonic
from typing import Any, Protocol

from windup.hal.errors import UsageError

Row = dict[str, Any]
KEY = ("command", "seed")  # columns that every row has
EVERY = 5.0  # interval of writing a Parquet file, which cannot be appended to, s


class Table(Protocol):
    """Rows that are stored in a file."""

    rows: list[Row]

    def append(self, row: Row) -> None:
        """Add a row; it is written at once, or soon after."""
        ...

    def close(self) -> None:
        """Ensure that every row is in the file."""
        ...


def open_table(path: Path) -> Table:
    """Return the table at `path`, with the rows that it already contains.

    Raises:
        UsageError: The suffix is unknown, or the file is not a sweep's.
    """
    if os.path.exists(path) and not os.path.isfile(path):
        raise UsageError(f"--out {path}: this is no file")
    if path.suffix == ".csv":
        return CsvTable(path)
    if path.suffix == ".parquet":
        return ParquetTable(path)
    raise UsageError(f"--out {path}: name it .csv or .parquet")


def typed(text: str) -> Any:
    """Return the value of a CSV cell, with its type.

    >>> [typed(text) for text in ("", "true", "3", "0.25", "sp")]
    [None, True, 3, 0.25, 'sp']
    """
    if text in ("true", "false", ""):
        return {"true": True, "false": False}.get(text)
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


class CsvTable:
    """A CSV file to which rows are appended; it is rewritten only for new columns.

    Args:
        path: The file; it need not exist.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            text = path.read_text(encoding="utf-8") if os.path.exists(path) else ""
            whole = text[: text.rfind("\n") + 1]  # without a last row cut off by a kill
            reader = csv.DictReader(io.StringIO(whole))
            self.columns = list(reader.fieldnames or [])
            self.rows: list[Row] = [{k: typed(v or "") for k, v in row.items()} for row in reader]
        except (OSError, UnicodeError, csv.Error, AttributeError) as error:
            raise UsageError(f"--out {path}: this file is no sweep's: {error}") from None
        _check(path, self.columns, empty=not text)
        if whole != text:
            self._write_all()

    def append(self, row: Row) -> None:
        """Add a row; it is in the file on return."""
        self.rows.append(row)
        new = [name for name in row if name not in self.columns]
        if new:
            self.columns += new
            self._write_all()
            return
        with self.path.open("a", encoding="utf-8", newline="") as file:
            file.write(self._text([row]))

    def close(self) -> None:
        """Do nothing: every row is in the file already."""

    def _write_all(self) -> None:
        whole = self.path.with_name(self.path.name + ".new")
        header = _line(self.columns)
        whole.write_text(header + self._text(self.rows), encoding="utf-8", newline="")
        replace(whole, self.path)

    def _text(self, rows: list[Row]) -> str:
        return "".join(_line([_cell(row.get(name)) for name in self.columns]) for row in rows)


class ParquetTable:
    """A Parquet file that is rewritten every few seconds and at the end.

    Args:
        path: The file; it need not exist.

    Raises:
        UsageError: polars is not installed, or the file is not a sweep's.
    """

    def __init__(self, path: Path) -> None:
        try:
            import polars
        except ImportError:
            raise UsageError(
                f"--out {path}: Parquet needs polars: pip install 'windup-robotics[sweep]', or "
                "name it .csv"
            ) from None
        self._polars = polars
        self.path = path
        self.rows: list[Row] = []
        self._written = monotonic()
        if os.path.exists(path):
            try:
                frame = polars.read_parquet(path)
            except polars.exceptions.PolarsError as error:
                raise UsageError(f"--out {path}: {str(error).splitlines()[0]}") from None
            _check(path, frame.columns, empty=False)
            self.rows = frame.to_dicts()

    def append(self, row: Row) -> None:
        """Add a row; it is in the file after a few seconds, or after `close`."""
        self.rows.append(row)
        if monotonic() > self._written + EVERY:
            self.close()

    def close(self) -> None:
        """Write all rows."""
        whole = self.path.with_name(self.path.name + ".new")
        names = list(dict.fromkeys(name for row in self.rows for name in row))
        columns = {name: _column([row.get(name) for row in self.rows]) for name in names}
        self._polars.DataFrame(columns, strict=False).write_parquet(whole)
        replace(whole, self.path)
        self._written = monotonic()


def _check(path: Path, columns: list[str], *, empty: bool) -> None:
    if not empty and not set(KEY) <= set(columns):
        raise UsageError(f"--out {path}: this file is no sweep's; name another one")


def _column(values: list[Any]) -> list[Any]:
    """Return a column of one type: text if it mixes numbers and text."""
    kinds = {type(value) for value in values if value is not None}
    if str in kinds and len(kinds) > 1:
        return [None if value is None else _cell(value) for value in values]
    return values


def _line(cells: list[str]) -> str:
    buffer = io.StringIO()
    csv.writer(buffer, lineterminator="\n").writerow(cells)
    return buffer.getvalue()


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return " ".join(str(value).splitlines())  # without line breaks: a row is one line
