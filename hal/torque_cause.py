"""What the registers of servos say of their torque: is it still there, and if not, why?"""

from collections.abc import Sequence
from typing import NamedTuple

from hal.bus import Bus
from hal.families import Family
from hal.servo_line import ServoLine
from hal.torque_loss import SWITCHED_OFF, UNEXPLAINED, Loss, restarted, shut_down, weakened

UNNAMED = "an error that its manual does not name"

Values = dict[int, int]
"""Id to what a register holds, of those who answered."""


class Suspect(NamedTuple):
    """A servo that may have lost its torque.

    Attributes:
        id: Its id.
        bits: The alert bits of its last answer.
        silent: Was it silent for so long that it may have restarted?
    """

    id: int
    bits: int
    silent: bool


class Evidence(NamedTuple):
    """What is known of a servo that may have lost its torque.

    Attributes:
        drives: Is its torque on?
        restarted: Has it restarted?
        errors: Bits of what it signals.
        unloading: Bits of the errors that end its torque, or weaken it.
    """

    drives: bool
    restarted: bool
    errors: int
    unloading: int


def examine(line: ServoLine, suspects: Sequence[Suspect], watched: bool) -> dict[int, Loss | None]:
    """Return id to how its torque was lost, None where it is there; who is silent is left out.

    Args:
        line: Their line.
        suspects: The servos.
        watched: Is their Bus Watchdog running, where they have one?
    """
    bus, family = line.bus, line.bus.family
    ids = [suspect.id for suspect in suspects]
    torque = _torque(bus, ids)
    slack = [id for id, values in torque.items() if _is_slack(family, values)]
    if slack and family.dialect.weak:  # one broken frame in 256 looks good
        again = _torque(bus, slack)
        torque = {id: values for id, values in torque.items() if id not in slack} | again
    unclear = [
        suspect
        for suspect in suspects
        if suspect.id in torque
        and (_is_slack(family, torque[suspect.id]) or suspect.bits & family.weakening)
    ]
    found: dict[int, Loss | None] = dict.fromkeys(torque)
    for suspect in unclear:
        del found[suspect.id]
    for id, evidence in _evidence(bus, unclear, torque, watched).items():
        found[id] = judge(family, evidence, line.lowest_supply())
    return found


def judge(family: Family, evidence: Evidence, volts: float) -> Loss | None:
    """Return how the torque was lost, or None if it is there; `volts` is the lowest supply, V."""
    signalled = evidence.errors & evidence.unloading
    weak, ended = signalled & family.weakening, signalled & ~family.weakening
    if evidence.restarted:
        return restarted(volts)
    if evidence.drives:
        return weakened(family.explain(weak)) if weak else None
    if ended:
        return shut_down(family.explain(ended) or (UNNAMED,))
    return SWITCHED_OFF if family.latching else UNEXPLAINED


def _torque(bus: Bus, ids: Sequence[int]) -> dict[int, dict[str, int]]:
    """Return id to the values of the family's registers of torque, of those who answered."""
    registers = [bus.family.registers[name] for name in bus.family.torque]
    begin = bus.family.torque_span(0).address
    answers = bus.bulk_read([bus.family.torque_span(id) for id in ids])
    places = [
        (each, slice(each.address - begin, each.address - begin + each.size)) for each in registers
    ]
    return {
        id: {register.name: register.decode(data[at]) for register, at in places}
        for id, data in answers.items()
    }


def _is_slack(family: Family, values: dict[str, int]) -> bool:
    """Return whether a servo does not drive, or has restarted and may drive to an old goal."""
    mark = family.mark
    again = mark is not None and values.get(mark.name) == mark.restarted
    return again or not all(values.values())


def _evidence(
    bus: Bus, suspects: Sequence[Suspect], torque: dict[int, dict[str, int]], watched: bool
) -> dict[int, Evidence]:
    """Return id to all that its registers say, as far as it could be read."""
    if not suspects:
        return {}
    family, mark = bus.family, bus.family.mark
    ids = [suspect.id for suspect in suspects]
    errors = {suspect.id: suspect.bits for suspect in suspects}
    if not family.errors_in_answers:
        errors = _values(bus, ids, "hardware_error")
    unloading = _values(bus, ids, family.shutdown)
    # Where no register tells, silence does.
    again = {suspect.id: suspect.silent for suspect in suspects}
    if mark is not None and mark.name in family.torque:
        again = {id: torque[id][mark.name] == mark.restarted for id in ids}
    elif mark is not None and watched:
        again = {id: v == mark.restarted for id, v in _values(bus, ids, mark.name).items()}
    known = [id for id in ids if id in errors and id in unloading and id in again]
    return {
        id: Evidence(all(torque[id].values()), again[id], errors[id], unloading[id]) for id in known
    }


def _values(bus: Bus, ids: Sequence[int], name: str) -> Values:
    counts, valid = bus.sync_read(ids, bus.family.registers[name])
    return {id: int(count) for id, count, has in zip(ids, counts, valid, strict=True) if has}
