"""Finds the emulation of a servo model or a protocol: Windup's own, or of another distribution."""

from collections.abc import Iterable
from pkgutil import resolve_name

from windup.hal.errors import PluginError, UnknownNameError, UsageError
from windup.hal.families import FAMILIES, Family, families, family_of, servo_model
from windup.hal.families.catalogue import ADDED_FAMILIES
from windup.hal.plugins.plugins import exception_text
from windup.sim_twin.wire.bus.bus import WireProtocol
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.shafts.shaft import Shaft
from windup.sim_twin.wire.world.emulation import Emulation
from windup.sim_twin.wire.world.own_emulations import EMULATIONS, PROTOCOLS


def full_name(name: str) -> str:
    """Return the name of a model; a family's short name ("XL430") means its first model.

    Upper and lower case are the same.

    >>> full_name("sts3215")
    'STS3215-7.4V'

    Raises:
        UnknownNameError: There is no such model.
    """
    if (own := _full_name(name, PROTOCOLS)) is not None:
        return own
    added = [model.name for family in ADDED_FAMILIES.all().values() for model in family.models]
    if (known := _full_name(name, added)) is not None:
        return known
    known_names = (*PROTOCOLS, *added)
    short = {each.split("-")[0] for each in known_names}
    series = {each for each in short if any(letter.isdigit() for letter in each)}
    raise UnknownNameError("servo model", name, series.union(known_names))


def make_protocol(name: str) -> WireProtocol:
    """Return a new instance of a protocol.

    Raises:
        UnknownNameError: There is no such protocol.
        PluginError: The family that has it cannot be emulated.
    """
    if name in EMULATIONS:
        return EMULATIONS[name].protocol()
    known = {family.protocol_name: family for family in families()}
    if name not in known:
        raise UnknownNameError("protocol", name, known)
    return _emulation_of(known[name]).protocol()


def make_servo(
    name: str,
    shaft: Shaft,
    identifier: int,
    baud: int,
    supply: float,
    return_delay: int = -1,
    protocol: str | None = None,
) -> Device:
    """Return a new servo.

    Args:
        name: Model name.
        shaft: The shaft that it drives.
        identifier: Bus id.
        baud: Baud rate.
        supply: Supply voltage, V.
        return_delay: Return delay, in units of 2 us; -1: the factory default.
        protocol: Protocol of its bus.

    Raises:
        UsageError: It does not support the protocol or the baud rate.
        PluginError: Its family cannot be emulated.
    """
    name = full_name(name)
    family = family_of(name)
    if protocol not in (None, family.protocol_name):
        spoken = family.protocol_name
        raise UsageError(f"servo {name} {identifier} uses protocol {spoken}, its bus {protocol}")
    emulation = _emulation_of(family)
    if baud not in (emulation.bauds or family.bauds):
        raise UsageError(f"servo {name} {identifier} does not support {baud} baud")
    return emulation.servo(servo_model(name), shaft, identifier, baud, supply, return_delay)


def _full_name(name: str, known: Iterable[str]) -> str | None:
    """Return the first of the names in `known` that is `name`, or begins with it and a dash."""
    low = name.casefold()
    forms = ((full, full.casefold()) for full in known)
    return next((full for full, form in forms if low in (form, form.split("-")[0])), None)


def _emulation_of(family: Family) -> Emulation:
    """Return how a family is emulated.

    Raises:
        PluginError: It has no emulation, or that cannot be imported.
    """
    if family in FAMILIES:
        return EMULATIONS[family.protocol_name]
    where = f"{ADDED_FAMILIES.origin(family)}: family {family.name!r}"
    if not family.emulation:
        raise PluginError(f"{where} has no emulation: its servos are driven on a real port only")
    try:
        found = resolve_name(family.emulation)
    except (Exception, SystemExit) as error:  # importing it runs code that is not ours
        why = exception_text(error)
        raise PluginError(f"{where}: emulation {family.emulation}: {why}") from None
    if not isinstance(found, Emulation):
        kind = type(found).__name__
        raise PluginError(
            f"{where}: emulation {family.emulation} should be a "
            f"windup.sim_twin.wire.world.emulation.Emulation, and is of type {kind}"
        )
    return found
