"""Inserts random mistakes into a valid MJCF file."""

import random
import xml.etree.ElementTree as ET
from collections.abc import Callable
from copy import deepcopy

from windup.tools.benches.fuzz import odd

Mistake = Callable[[random.Random, ET.Element], None]


def broken_mjcf(rng: random.Random, text: str) -> str:
    """Return `text` with one to three mistakes; sometimes it is no longer valid XML."""
    root = ET.fromstring(text)
    for _ in range(rng.randint(1, 3)):
        rng.choice(MISTAKES)(rng, root)
    broken = ET.tostring(root, encoding="unicode")
    return broken[: rng.randrange(len(broken))] if rng.random() < 0.05 else broken


def _drawn(rng: random.Random, root: ET.Element) -> ET.Element:
    return rng.choice(list(root.iter()))


def other_value(rng: random.Random, root: ET.Element) -> None:
    """Give an attribute an odd value, as a whole or in one of its numbers."""
    element = _drawn(rng, root)
    if not element.attrib:
        return
    name = rng.choice(sorted(element.attrib))
    words = element.attrib[name].split()
    if words and rng.random() < 0.6:
        words[rng.randrange(len(words))] = odd.number(rng)
    else:
        words = [_printable(odd.word(rng))]
    element.attrib[name] = " ".join(words)


def without_attribute(rng: random.Random, root: ET.Element) -> None:
    """Remove an attribute."""
    element = _drawn(rng, root)
    if element.attrib:
        del element.attrib[rng.choice(sorted(element.attrib))]


def without_element(rng: random.Random, root: ET.Element) -> None:
    """Remove an element and its contents."""
    parent = _drawn(rng, root)
    if len(parent):
        parent.remove(rng.choice(list(parent)))


def element_twice(rng: random.Random, root: ET.Element) -> None:
    """Duplicate an element."""
    parent = _drawn(rng, root)
    if len(parent):
        parent.append(deepcopy(rng.choice(list(parent))))


def element_elsewhere(rng: random.Random, root: ET.Element) -> None:
    """Insert a copy of an element into another one."""
    _drawn(rng, root).append(deepcopy(_drawn(rng, root)))


def _printable(word: str) -> str:
    """Return a word without the characters that XML cannot represent."""
    return "".join(letter for letter in word if letter.isprintable())


MISTAKES: tuple[Mistake, ...] = (
    *(other_value,) * 4,
    *(without_attribute,) * 2,
    *(without_element,) * 2,
    element_twice,
    element_elsewhere,
)
