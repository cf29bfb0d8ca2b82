"""The report as one HTML page with its pictures inside; nothing is fetched from anywhere."""

from base64 import b64encode
from dataclasses import dataclass
from html import escape

import mujoco

from windup.tools.command_line.version import installed_version
from windup.tools.reproduce.study.figure import Claim, DataTable, Figure, Study

STYLE = """
body { font: 15px/1.5 sans-serif; max-width: 1060px; margin: 2em auto; padding: 0 1em; color: #222 }
table { border-collapse: collapse; margin: 1em 0 } caption { text-align: left; color: #555 }
th, td { border: 1px solid #ccc; padding: .25em .6em; text-align: left; vertical-align: top }
th { background: #f3f3f3 } img { max-width: 100% } section { margin-top: 3em }
.agree, .reached { color: #1a7f37; font-weight: bold }
.differ, .missed { color: #b35900; font-weight: bold }
.theirs { border-left: 4px solid #ccc; padding-left: 1em; color: #444 }
"""


@dataclass(frozen=True)
class Entry:
    """One figure of the report, done.

    Attributes:
        figure: What it is.
        png: The picture.
        claims: The paper's statements beside ours.
        tables: The numbers behind it.
        runs: How many runs it rests on.
    """

    figure: Figure
    png: bytes
    claims: list[Claim]
    tables: list[DataTable]
    runs: int

    @property
    def count(self) -> str:
        """How many of the paper's statements agree, for people."""
        theirs = [claim.word for claim in self.claims if not claim.own]
        text = f"{theirs.count('agree')} of {len(theirs)} agree"
        return text + (f", {theirs.count('open')} open" if "open" in theirs else "")


def page(study: Study, entries: list[Entry], *, quick: bool) -> str:
    """Return the report."""
    kind = "a few runs for each figure (--quick)" if quick else "all runs"
    parts = [
        f"<!doctype html><html lang='en'><head><meta charset='utf-8'>"
        f"<title>{escape(study.title)}</title><style>{STYLE}</style></head><body>",
        f"<h1>{escape(study.title)}</h1><p>{escape(study.source)}</p>",
        f"<p>{escape(study.setting)}</p>",
        f"<p>Windup {installed_version()}, MuJoCo {mujoco.__version__}; {kind}. "
        "Each verdict is computed from the runs; what would agree stands in brackets.</p>",
        _overview(entries),
        *(_section(entry) for entry in entries),
        _missing(study),
        "</body></html>\n",
    ]
    return "\n".join(parts)


def _overview(entries: list[Entry]) -> str:
    rows = [
        [
            f"<a href='#f{escape(entry.figure.name)}'>{escape(entry.figure.name)}</a>",
            escape(entry.figure.title),
            entry.count,
        ]
        for entry in entries
    ]
    return _table("", ["figure", "what it shows", "its statements"], rows)


def _section(entry: Entry) -> str:
    figure = entry.figure
    image = b64encode(entry.png).decode()
    claims = [
        [
            ("<i>our own mark:</i> " if claim.own else "") + escape(claim.theirs),
            escape(claim.reason),
            f"<span class='{claim.word}'>{claim.word}</span>",
        ]
        for claim in entry.claims
    ]
    tables = [
        _table(item.caption, item.header, [[escape(cell) for cell in row] for row in item.rows])
        for item in entry.tables
    ]
    return "\n".join(
        [
            f"<section id='f{escape(figure.name)}'>",
            f"<h2>{escape(figure.name)} {escape(figure.title)}</h2>",
            f"<p class='theirs'>{escape(figure.statement)}</p>",
            f"<img alt='{escape(figure.title)}' src='data:image/png;base64,{image}'>",
            _table("", ["the paper", "ours", ""], claims),
            *tables,
            f"<p>From {entry.runs} runs.</p></section>",
        ]
    )


def _missing(study: Study) -> str:
    if not study.missing:
        return ""
    rows = [[escape(name), escape(why)] for name, why in study.missing.items()]
    return "<section><h2>Not yet</h2>" + _table("", ["figure", "why"], rows) + "</section>"


def _table(caption: str, header: list[str], rows: list[list[str]]) -> str:
    """Return a table; the cells are HTML already."""
    head = "".join(f"<th>{escape(name)}</th>" for name in header)
    body = "\n".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in rows)
    title = f"<caption>{escape(caption)}</caption>" if caption else ""
    return f"<table>{title}<tr>{head}</tr>\n{body}</table>"
