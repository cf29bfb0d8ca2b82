"""Messages about settings that will be changed in servos, and about unusual protection limits."""

from collections.abc import Iterator, Sequence

from windup.hal.bus.servo_differences import ServoDifferences
from windup.hal.bus.servo_settings import SettingDifference

MANY = 4
"""Maximum number of joints that a message names; more are counted."""


def format_settings(found: Sequence[ServoDifferences]) -> list[str]:
    """Return a line about EEPROM changes, grouped by joints, and a line about unusual limits.

    RAM registers are not mentioned: they are lost without power, and are set at every start.
    """
    changes = [
        (differences.joint, change) for differences in found for change in _changes(differences)
    ]
    limits = [
        (
            differences.joint,
            f"{limit.register.name} {limit.present} (factory default: {limit.wanted})",
        )
        for differences in found
        for limit in differences.limits
    ]
    lines = (
        ("changing servo settings", changes),
        ("protection limits differ from the factory defaults", limits),
    )
    return [f"{head}: {_grouped(pairs, len(found))}" for head, pairs in lines if pairs]


def _changes(differences: ServoDifferences) -> Iterator[str]:
    """Yield a description of each EEPROM change in one servo."""
    if differences.repaired:
        yield differences.repaired
    for setting in differences.settings:
        if setting.register.area == "eeprom":
            yield _change(setting)


def _change(setting: SettingDifference) -> str:
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
