"""Descriptions of a record and of its keys, from the record's docstring."""

import inspect
import re
from typing import Any

ENTRY = re.compile(r"^    (\w+): (.*)$")
"""The first line of an attribute in a Google docstring."""


def record_text(record: type[Any]) -> str:
    """Return the docstring of a record without its attributes, one line for each paragraph."""
    head = (inspect.getdoc(record) or "").split("\nAttributes:\n")[0]
    return "\n".join(" ".join(part.split()) for part in head.split("\n\n")).strip()


def key_texts(record: type[Any]) -> dict[str, str]:
    """Return the descriptions of a record's keys, including those of its base classes."""
    texts: dict[str, str] = {}
    for kind in reversed(record.__mro__):
        texts |= _attributes(inspect.cleandoc(kind.__doc__ or ""))
    return texts


def _attributes(doc: str) -> dict[str, str]:
    """Return the attributes of one docstring, one line each."""
    texts: dict[str, str] = {}
    key = ""
    for line in doc.partition("\nAttributes:\n")[2].splitlines():
        if found := ENTRY.match(line):
            key = found[1]
            texts[key] = found[2]
        elif line.startswith("        ") and key:
            texts[key] += f" {line.strip()}"
        elif line.strip():
            break  # the next section
    return texts
