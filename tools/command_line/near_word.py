"""Suggests the known word that is most similar to an unknown one."""

from collections.abc import Iterable
from difflib import get_close_matches


def near_word(word: str, known: Iterable[str]) -> str:
    """Return a suggestion for a misspelt word; "" if no known word is similar.

    >>> near_word("wlak", ["play", "walk"])
    ' (did you mean walk?)'
    """
    near = get_close_matches(word, sorted(known), n=1, cutoff=0.6)
    return f" (did you mean {near[0]}?)" if near else ""
