"""Inserts random mistakes into a valid MJCF file."""

import random
import xml.etree.ElementTree as ET
from collections.abc import Callable
from copy import deepcopy

from windup.tools.benches.fuzz import odd

Mistake = Callable[[random.Random, ET.Element], None]


def broken_mjcf(dice: random.Random, text: str) -> str:
    """Return `text` with one to three mistakes; sometimes it is no longer valid XML."""
    root = ET.fromstring(text)
    for _ in range(dice.randint(1, 3)):
        dice.choice(MISTAKES)(dice, root)
    broken = ET.tostring(root, encoding="unicode")
    return broken[: dice.randrange(len(broken))] if dice.random() < 0.05 else broken


def _drawn(dice: random.Random, root: ET.Element) -> ET.Element:
    return dice.choice(list(root.iter()))


def other_value(dice: random.Random, root: ET.Element) -> None:
    """Give an attribute an odd value, as a whole or in one of its numbers."""
    element = _drawn(dice, root)
    if not element.attrib:
        return
    name = dice.choice(sorted(element.attrib))
    words = element.attrib[name].split()
    if words and dice.random() < 0.6:
        words[dice.randrange(len(words))] = odd.number(dice)
    else:
        words = [_printable(odd.word(dice))]
    element.attrib[name] = " ".join(words)


def without_attribute(dice: random.Random, root: ET.Element) -> None:
    """Remove an attribute."""
    element = _drawn(dice, root)
    if element.attrib:
        del element.attrib[dice.choice(sorted(element.attrib))]


def without_element(dice: random.Random, root: ET.Element) -> None:
    """Remove an element and its contents."""
    parent = _drawn(dice, root)
    if len(parent):
        parent.remove(dice.choice(list(parent)))


def element_twice(dice: random.Random, root: ET.Element) -> None:
    """Duplicate an element."""
    parent = _drawn(dice, root)
    if len(parent):
        parent.append(deepcopy(dice.choice(list(parent))))


def element_elsewhere(dice: random.Random, root: ET.Element) -> None:
    """Insert a copy of an element into another one."""
    _drawn(dice, root).append(deepcopy(_drawn(dice, root)))


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
