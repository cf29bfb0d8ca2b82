"""Checks that the servos are wired as robot.toml says; one message lists all differences."""

from collections.abc import Mapping, Sequence
from itertools import combinations
from math import degrees
from shlex import quote

import numpy as np

from windup.hal.bus.bus import Bus
from windup.hal.bus.servo_differences import ServoDifferences
from windup.hal.bus.servo_settings import SettingDifference, differences, limits
from windup.hal.bus.status_return_level import enable_answers
from windup.hal.errors import (
    ConfigError,
    CorruptAnswerError,
    HardwareError,
    NoAnswerError,
    UnknownNameError,
)
from windup.hal.families import DYNAMIXEL_X, Family, family_of
from windup.hal.imu.opencr import OpenCr
from windup.hal.joints import Joints
from windup.hal.servo_bus.coupling import Couplings
from windup.hal.servo_bus.units import Units
from windup.hal.servos.servo_model import ServoMount

PROTOCOL_1 = "uses protocol 1: set its Protocol Type (register 13) to 2 with DYNAMIXEL Wizard"
"""Message for an X series servo that answers in protocol 1."""


def check_mounts(
    joints: Joints,
    mounts: Sequence[ServoMount],
    buses: Mapping[str, object],
    units: Units,
    couplings: Couplings,
) -> None:
    """Check the configured wiring before any port is opened.

    Raises:
        ConfigError: Two families on one bus, a duplicate id, or a joint range beyond the
            encoder's; the message names the joints.
        UnknownNameError: A mount names a bus that has no port.
    """
    for mount in mounts:
        if mount.bus not in buses:
            raise UnknownNameError("bus", mount.bus, buses)
    named = list(zip(joints.names, mounts, strict=True))
    _check_families(named)
    for (first, one), (second, other) in combinations(named, 2):
        if (one.bus, one.id) == (other.bus, other.id):
            raise ConfigError(
                f"joints {first!r} and {second!r} both have id {one.id} on bus {one.bus!r}"
            )
    servo_range = couplings.servo_range(joints.lower, joints.upper)
    for row, (name, mount) in enumerate(named):
        ends = sorted(float(units.counts(end)[row]) for end in servo_range)
        bottom, top = mount.first_count, mount.last_count
        if ends[0] < bottom or ends[1] > top:
            raise ConfigError(
                f"joint {name!r} (id {mount.id} on bus {mount.bus!r}): its range is "
                f"{ends[0]:.0f} to {ends[1]:.0f} counts, its encoder ends at {bottom} and {top}; "
                "narrow the range in robot.toml or turn the horn and calibrate"
            )


def bus_families(mounts: Sequence[ServoMount]) -> dict[str, Family]:
    """Return the family of the first servo of each bus, by bus name."""
    families: dict[str, Family] = {}
    for mount in mounts:
        families.setdefault(mount.bus, family_of(mount.model.name))
    return families


def _check_families(named: Sequence[tuple[str, ServoMount]]) -> None:
    families = bus_families([mount for _, mount in named])
    for name, mount in named:
        family, first = family_of(mount.model.name), families[mount.bus]
        if family is not first:
            raise ConfigError(
                f"joint {name!r}: a {mount.model.name} is {family.name}, the other servos on bus "
                f"{mount.bus!r} are {first.name}; give each family a bus of its own"
            )


def check_servos(
    joints: Joints, mounts: Sequence[ServoMount], buses: Mapping[str, Bus], board: OpenCr | None
) -> list[ServoDifferences]:
    """Check every servo, and return the settings that have to be written to each.

    Nothing is written except the status return level of a servo that does not answer reads.

    Raises:
        HardwareError: A servo is missing, is another model, or needs a write while its torque
            is on; one message lists all such servos, with the command to run next.
    """
    problems: dict[str, list[str]] = {}
    found: list[ServoDifferences] = []
    for name, mount in zip(joints.names, mounts, strict=True):
        bus = buses[mount.bus]
        try:
            found.append(ServoDifferences(bus, mount.id, name, *_inspect(bus, mount)))
        except HardwareError as error:
            who = f"joint {name!r} id {mount.id}: {_short(error)}"
            problems.setdefault(bus.port.url, []).append(who)
    if board is not None:
        bus = buses[board.bus]
        if bus.family is not DYNAMIXEL_X:
            raise ConfigError(f"an OpenCR cannot be on bus {board.bus!r} of {bus.family.name}")
        try:
            bus.ping(board.id)
        except HardwareError as error:
            who = f"OpenCR id {board.id}: {_short(error)}"
            problems.setdefault(bus.port.url, []).append(who)
    if problems:
        raise HardwareError("; ".join(_sentence(url, each) for url, each in problems.items()))
    return found


def _inspect(
    bus: Bus, mount: ServoMount
) -> tuple[list[SettingDifference], list[SettingDifference], str]:
    try:
        number = bus.ping(mount.id)
    except NoAnswerError:
        other = bus.family.protocol.other_protocol(bus.port, mount.id)
        if other is None or other not in bus.family.numbers:
            raise
        raise HardwareError(f"{bus.family.model_name(other)} {PROTOCOL_1}") from None
    if number != mount.model.model_number:
        there = bus.family.model_name(number)
        raise HardwareError(f"is a {there} where a {mount.model.name} should be")
    try:
        return _settings(bus, mount)
    except NoAnswerError as error:
        raise HardwareError(
            f"answers pings, but not all other requests{_extra_bytes(error)}; a loose cable, or a "
            "weak supply?"
        ) from None


def _settings(
    bus: Bus, mount: ServoMount
) -> tuple[list[SettingDifference], list[SettingDifference], str]:
    """Return the settings to write, the unusual protection limits, and what was repaired."""
    repaired = enable_answers(bus, mount.id, mount.model)
    _check_offset(bus, mount)
    settings = differences(bus, mount)
    locked = [str(setting) for setting in settings if setting.register.area == "eeprom"]
    if locked and bus.read(mount.id, bus.family.registers["torque_enable"]):
        raise HardwareError(
            f"cannot correct {', '.join(locked)} while torque is on; "
            "switch it off with `windup stop` first"
        )
    return settings, limits(bus, mount.id, mount.model), repaired


def _check_offset(bus: Bus, mount: ServoMount) -> None:
    """Raise unless the homing offset is the one for which the joint's zero was calibrated.

    Raises:
        HardwareError: They differ, so joint angles would be wrong by the difference.
    """
    table = bus.family.table(mount.model.name)
    if "homing_offset" not in table:
        return
    register = table["homing_offset"]
    if (present := bus.read(mount.id, register)) == mount.offset:
        return
    off = degrees(abs(present - mount.offset) * register.unit)
    raise HardwareError(
        f"its homing offset is {present} counts where robot.toml says {mount.offset}: {off:.1f} "
        f"degrees off; write `offset = {present}` there if its zero was found with it, else set "
        f"the offset of the servo to {mount.offset}"
    )


def _short(error: HardwareError) -> str:
    if isinstance(error, NoAnswerError):
        return f"no answer{_extra_bytes(error)}"
    if isinstance(error, CorruptAnswerError):
        return "only corrupt answers (two servos with this id?)"
    return str(error)


def _extra_bytes(error: NoAnswerError) -> str:
    return f", but {error.extra_bytes} bytes that do not belong to one" if error.extra_bytes else ""


def _sentence(url: str, problems: list[str]) -> str:
    count = f"{len(problems)} thing{'s' if len(problems) > 1 else ''}"
    listed = "; ".join(problems)
    return f"{url}: {count} not as in robot.toml: {listed}; run `windup scan {quote(url)}`"


def row_groups(mounts: Sequence[ServoMount]) -> dict[str, list[int]]:
    """Return the indices of the joints on each bus, by bus name."""
    names = np.array([mount.bus for mount in mounts])
    return {str(name): np.flatnonzero(names == name).tolist() for name in dict.fromkeys(names)}
