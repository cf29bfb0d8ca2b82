"""Messages about settings that will be changed in servos, and about unusual protection limits."""

from collections.abc import Iterator, Sequence

from windup.hal.bus.differs import Differs
from windup.hal.bus.servo_settings import Setting

MANY = 4
"""Maximum number of joints that a message names; more are counted."""


def in_words(found: Sequence[Differs]) -> list[str]:
    """Return a line about EEPROM changes, grouped by joints, and a line about unusual limits.

    RAM registers are not mentioned: they are lost without power, and are set at every start.
    """
    changes = [(differs.joint, change) for differs in found for change in _changes(differs)]
    limits = [
        (differs.joint, f"{limit.register.name} {limit.present} (usual: {limit.wanted})")
        for differs in found
        for limit in differs.limits
    ]
    lines = (
        ("servo settings are changed", changes),
        ("protection limits differ from the factory's", limits),
    )
    return [f"{head}: {_grouped(pairs, len(found))}" for head, pairs in lines if pairs]


def _changes(differs: Differs) -> Iterator[str]:
    """Yield a description of each EEPROM change in one servo."""
    if differs.repaired:
        yield differs.repaired
    for setting in differs.settings:
        if setting.register.area == "eeprom":
            yield _change(setting)


def _change(setting: Setting) -> str:
    return f"{setting.register.name} {setting.present} -> {setting.wanted}"


def _grouped(pairs: Sequence[tuple[str, str]], all_: int) -> str:
    """Return the texts of (joint, text) pairs, each once, with the joints it applies to."""
    joints: dict[str, list[str]] = {}
    for joint, what in pairs:
        joints.setdefault(what, []).append(joint)
    return "; ".join(f"{what} at {_some(names, all_)}" for what, names in joints.items())


def _some(names: Sequence[str], all_: int) -> str:
    """Return the names of some joints, or their number if there are more than `MANY`."""
    if len(names) == all_ > 1:
        return f"all {all_} joints"
    return ", ".join(names) if len(names) <= MANY else f"{len(names)} joints"
