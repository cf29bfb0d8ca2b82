"""Determines from the servos' registers whether they still have torque, and if not, why."""

from collections.abc import Sequence
from typing import NamedTuple

from windup.hal.bus.bus import Bus
from windup.hal.families import Family
from windup.hal.servo_bus.bus_readout import BusReadout
from windup.hal.torque_loss import (
    SWITCHED_OFF,
    UNEXPLAINED,
    Loss,
    reduced_torque_loss,
    restart_loss,
    shutdown_loss,
)

UNNAMED = "an error without a documented name"

Values = dict[int, int]
"""Maps id to the value of a register, for the servos that answered."""


class Suspect(NamedTuple):
    """A servo that may have lost its torque.

    Attributes:
        id: Its id.
        silent: Whether it was silent for so long that it may have restarted.
    """

    id: int
    silent: bool


class Readback(NamedTuple):
    """Torque registers and alert bits read back from one servo.

    Attributes:
        values: Values of the family's torque registers, by name.
        bits: Alert bits of the status packet.
    """

    values: dict[str, int]
    bits: int

    @property
    def torque_on(self) -> bool:
        """Whether torque is on."""
        return all(self.values.values())


class Evidence(NamedTuple):
    """Evidence for judging whether a servo has lost its torque.

    Attributes:
        torque_on: Whether its torque is on.
        restarted: Whether it has restarted.
        errors: Bits of the errors that it reports.
        unloading: Bits of the errors that end its torque, or reduce it.
    """

    torque_on: bool
    restarted: bool
    errors: int
    unloading: int


def find_torque_losses(
    readout: BusReadout, suspects: Sequence[Suspect], watched: bool
) -> dict[int, Loss | None]:
    """Map id to how its torque was lost, or None if it has torque; silent servos are omitted.

    Args:
        readout: The bus of the servos.
        suspects: The servos.
        watched: Whether their Bus Watchdog is running.
    """
    bus, family = readout.bus, readout.bus.family
    back = _read_back(bus, [suspect.id for suspect in suspects])
    without_torque = [id for id, seen in back.items() if _is_without_torque(family, seen)]
    if without_torque and family.protocol.weak:  # one corrupt frame in 256 passes the checksum
        again = _read_back(bus, without_torque)
        back = {id: seen for id, seen in back.items() if id not in without_torque} | again
    unclear = [suspect for suspect in suspects if _is_unclear(family, back.get(suspect.id))]
    found: dict[int, Loss | None] = dict.fromkeys(back)
    for suspect in unclear:
        del found[suspect.id]
    for id, evidence in _evidence(bus, unclear, back, watched).items():
        found[id] = torque_loss_of(family, evidence, readout.lowest_supply())
    return found


def torque_loss_of(family: Family, evidence: Evidence, volts: float) -> Loss | None:
    """Return how the torque was lost, or None if it is on; `volts` is the lowest supply, V."""
    signalled = evidence.errors & evidence.unloading
    weak, ended = signalled & family.weakening, signalled & ~family.weakening
    if evidence.restarted:
        return restart_loss(volts)
    if evidence.torque_on:
        return reduced_torque_loss(family.explain(weak)) if weak else None
    if ended:
        return shutdown_loss(family.explain(ended) or (UNNAMED,))
    return SWITCHED_OFF if family.latching else UNEXPLAINED


def _read_back(bus: Bus, ids: Sequence[int]) -> dict[int, Readback]:
    """Map id to the torque registers read back, for the servos that answered."""
    family = bus.family
    registers = [family.registers[name] for name in family.torque]
    begin = family.torque_span(0).address
    spans = [family.torque_span(id) for id in ids]
    found = {}
    for id, status in bus.read_statuses(spans, rest=True).items():
        values = {
            each.name: each.decode(status.params[each.address - begin :][: each.size])
            for each in registers
        }
        found[id] = Readback(values, status.error & family.alert)
    return found


def _is_without_torque(family: Family, seen: Readback) -> bool:
    """Return whether a servo has no torque, or has restarted and may move to an old goal."""
    mark = family.restart_mark
    again = mark is not None and seen.values.get(mark.name) == mark.restarted
    return again or not seen.torque_on


def _is_unclear(family: Family, seen: Readback | None) -> bool:
    """Return whether more registers are needed to judge the torque of a servo that answered."""
    return seen is not None and (
        _is_without_torque(family, seen) or bool(seen.bits & family.weakening)
    )


def _evidence(
    bus: Bus, suspects: Sequence[Suspect], back: dict[int, Readback], watched: bool
) -> dict[int, Evidence]:
    """Map id to the evidence from its registers, for the servos that could be read."""
    if not suspects:
        return {}
    family, mark = bus.family, bus.family.restart_mark
    ids = [suspect.id for suspect in suspects]
    errors = {id: back[id].bits for id in ids}
    if not family.errors_in_answers:
        errors = _values(bus, ids, "hardware_error")
    unloading = _values(bus, ids, family.shutdown)
    # Without a register that detects a restart, silence counts as one.
    again = {suspect.id: suspect.silent for suspect in suspects}
    if mark is not None and mark.name in family.torque:
        again = {id: back[id].values[mark.name] == mark.restarted for id in ids}
    elif mark is not None and watched:
        again = {id: v == mark.restarted for id, v in _values(bus, ids, mark.name).items()}
    known = [id for id in ids if id in errors and id in unloading and id in again]
    return {id: Evidence(back[id].torque_on, again[id], errors[id], unloading[id]) for id in known}


def _values(bus: Bus, ids: Sequence[int], name: str) -> Values:
    counts, valid = bus.sync_read(ids, bus.family.registers[name])
    return {id: int(count) for id, count, has in zip(ids, counts, valid, strict=True) if has}
