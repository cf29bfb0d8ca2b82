"""The known word that a wrong one is nearest to."""

from collections.abc import Iterable
from difflib import get_close_matches


def near_word(word: str, known: Iterable[str]) -> str:
    """Return in words which known one may have been meant; "" where none is near.

    >>> near_word("wlak", ["play", "walk"])
    ' (did you mean walk?)'
    """
    near = get_close_matches(word, sorted(known), n=1, cutoff=0.6)
    return f" (did you mean {near[0]}?)" if near else ""
