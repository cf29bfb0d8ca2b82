"""Links between pages lead somewhere, and no page tells people to install the wrong package."""

import re
from pathlib import Path

import pytest

from tests.docs.pages import PAGES, ROOT, name_of, read

LINK = re.compile(r"\]\(([^)#\s]*)(?:#([^)\s]*))?\)")
CODE = re.compile(r"^```.*?^```$", flags=re.DOTALL | re.MULTILINE)


def anchors(page: Path) -> set[str]:
    """Return the anchors that MkDocs gives the headings of a page."""
    heads = re.findall(r"^#+ (.*)$", CODE.sub("", read(page)), flags=re.MULTILINE)
    kept = [re.sub(r"[^\w\s-]", "", head).strip().lower() for head in heads]
    return {re.sub(r"[-\s]+", "-", head) for head in kept}


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_link_leads_somewhere(page: Path) -> None:
    for target, anchor in LINK.findall(CODE.sub("", read(page))):
        if "://" in target:
            continue
        there = page if not target else (page.parent / target).resolve()
        assert there.exists(), target
        assert not anchor or anchor in anchors(there), f"{target}#{anchor}"


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_no_page_installs_the_date_time_library(page: Path) -> None:
    assert not re.search(r"pip install [^\n]*\bwindup(?!-robotics)\b", read(page))


def test_every_page_is_in_the_navigation() -> None:
    listed = set(re.findall(r": (\w+\.md)$", (ROOT / "mkdocs.yml").read_text(), re.MULTILINE))
    assert listed == {page.name for page in PAGES if page.parent.name == "docs"}
