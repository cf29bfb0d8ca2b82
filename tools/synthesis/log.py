"""The file of a search: one line with its settings, then one for each trial."""

import json
from pathlib import Path
from typing import Any

from windup.hal.errors import UsageError
from windup.tools.terminal.output import to_json_types
from windup.tools.terminal.writing import writing

Entry = dict[str, Any]


class SearchLog:
    """Stored trials by number; each is written to the file as soon as it has been walked.

    The optimiser is deterministic: with the same seed and costs it repeats the same search, so that
    only the costs must be stored to continue an interrupted search.

    Args:
        path: The file; it need not exist.
        setup: Settings of the search.

    Raises:
        UsageError: The file contains another search, or cannot be read or written.
    """

    def __init__(self, path: Path, setup: dict[str, Any]) -> None:
        self.path = path
        self.entries: dict[int, Entry] = {}
        setup = json.loads(json.dumps(to_json_types(setup)))
        try:
            text = path.read_text(encoding="utf-8") if path.exists() else ""
            whole = text[: text.rfind("\n") + 1]  # without a last line cut off by a kill
            if whole:
                self._read(whole.splitlines(), setup)
            else:
                whole = json.dumps({"setup": setup}) + "\n"
            path.write_text(whole, encoding="utf-8")
        except OSError as error:
            raise UsageError(f"{path}: {error.strerror}") from None

    def add(self, number: int, entry: Entry) -> None:
        """Store a trial; it is in the file on return."""
        entry = to_json_types(entry)
        self.entries[number] = entry
        with writing(self.path), self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"trial": number, **entry}) + "\n")

    def _read(self, lines: list[str], setup: dict[str, Any]) -> None:
        try:
            first, *rest = [json.loads(line) for line in lines]
            kept = first["setup"]
            self.entries = {entry.pop("trial"): entry for entry in rest}
        except (ValueError, KeyError, TypeError, AttributeError):
            raise UsageError(f"{self.path}: this file is no search's; name another --out") from None
        other = [name for name in setup if kept.get(name) != setup[name]]
        if other:
            raise UsageError(
                f"{self.path}: holds a search with another {', '.join(other)}; "
                "give the same options to go on, or name another --out"
            )
