"""Looking for servos on a port: who answers at which baud rate, and what else does."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from windup.hal.bus.bus import FIRST, Bus, Found
from windup.hal.errors import CorruptAnswerError, HardwareError
from windup.hal.families import DYNAMIXEL_1, DYNAMIXEL_X, FAMILIES, Family
from windup.hal.imu.opencr import MODEL_NUMBER as OPENCR
from windup.hal.imu.opencr import VOLTAGE
from windup.hal.port.port import Port
from windup.hal.registers import Register
from windup.tools.bringup.raw_answers import Strange, is_echo, strange_answers

ANSWER_BYTES: Final = {True: 27, False: 14}
"""What a scan reads of one servo in protocol 1, where it is pinged, read, pinged and read, and in
protocol 2, where one ping tells all."""
SLOW: Final = 57_600
"""Over a bridge that keeps its baud rate to itself, answers may take as long as at this one."""
REGISTERS: Final = ("present_voltage", "present_temperature", "hardware_error")
"""What is read of a servo that was found."""


@dataclass
class Survey:
    """What was found on a port.

    Args:
        port: The port; it is left at the baud rate it had.
        joints: Servo id to the name of the joint that it should drive.

    Attributes:
        servos: What each servo says of itself.
        unknown: Servos that answer and are no model of ours: id, baud, and what the register of
            the model number holds, by the name of the family that would have it there.
        protocol_1: Servos of the X series that speak protocol 1: id, baud and model.
        strange: Other answers, with the baud rate and the family that was asked for.
    """

    port: Port
    joints: dict[int, str]
    servos: list[dict[str, Any]] = field(default_factory=list)
    unknown: list[dict[str, Any]] = field(default_factory=list)
    protocol_1: list[dict[str, Any]] = field(default_factory=list)
    strange: list[tuple[int, Family, Strange]] = field(default_factory=list)

    @property
    def doubled(self) -> list[int]:
        """Ids from which only broken answers come, beside servos whose answers are whole."""
        ids = {one.id for _, _, one in self.strange if one.id is not None and not one.whole}
        return sorted(ids | {row["id"] for row in self.servos if row["broken"]})

    @property
    def echo(self) -> bool:
        """Does the adapter send back what it is sent?"""
        return self.port.echoes or any(is_echo(one.data) for _, _, one in self.strange)

    def update(self, baud: int | None, begin: Callable[[str], None]) -> None:
        """Look for servos of every family.

        Args:
            baud: At this baud rate only; None: at all that a family knows.
            begin: Called with what is looked for, before it is.
        """
        before = self.port.baud
        others: dict[tuple[int | None, int], dict[str, int]] = {}
        try:
            for family, rate in places(self.port, baud):
                begin(f"{family.name}, {rate} baud" if self.port.has_baud else family.name)
                for servo in self._ask(family, rate):
                    shown = rate if self.port.has_baud else None
                    if servo.model_number in (*family.numbers, OPENCR) or not family.dialect.weak:
                        self._add(Bus(self.port, family), servo, shown)
                    else:
                        others.setdefault((shown, servo.id), {})[family.name] = servo.model_number
                if self.echo and not self.port.echoes:
                    break  # nothing can be made of it
        finally:
            self.port.baud = before
        # Protocol 1 is spoken by three families: what answers one of them answers all.
        known = {(row["baud"], row["id"]) for row in self.servos}
        for (shown, id), numbers in others.items():
            model = DYNAMIXEL_X.numbers.get(numbers.get(DYNAMIXEL_1.name, 0))
            if model is not None:
                self.protocol_1.append({"id": id, "baud": shown, "model": model})
            elif (shown, id) not in known:
                self.unknown.append({"id": id, "baud": shown, "numbers": numbers})

    def _ask(self, family: Family, rate: int) -> list[Found]:
        """Return who answers as a servo; keep what else comes."""
        bus, self.port.baud = Bus(self.port, family), rate
        bus.get_to_know_adapter(FIRST)
        before = self.port.received
        found = bus.scan([rate])
        more = self.port.received - before - ANSWER_BYTES[family.dialect.weak] * len(found)
        if more > 0:
            self.port.baud = rate
            self.strange += [(rate, family, one) for one in strange_answers(self.port, family)]
        return found

    def _add(self, bus: Bus, servo: Found, shown: int | None) -> None:
        if servo.model_number not in (*bus.family.numbers, OPENCR):
            numbers = {bus.family.name: servo.model_number}
            self.unknown.append({"id": servo.id, "baud": shown, "numbers": numbers})
            return
        self.servos.append(_describe(bus, servo) | {"baud": shown})
        self.servos[-1]["joint"] = self.joints.get(servo.id, "")


def places(port: Port, baud: int | None = None) -> Iterator[tuple[Family, int]]:
    """Yield where to look: every family at every baud rate of its, or at one.

    Behind a bridge that does not pass a baud rate on, that is once a family. Protocol 1 is looked
    for at the baud rates of the X series too, which may be set to speak it.
    """
    for family in FAMILIES:
        if not port.has_baud:
            yield family, SLOW
            continue
        bauds = [*family.bauds]
        if family is DYNAMIXEL_1:
            bauds += [rate for rate in DYNAMIXEL_X.bauds if rate not in family.bauds]
        yield from ((family, rate) for rate in bauds if baud in (None, rate))


def _describe(bus: Bus, servo: Found) -> dict[str, Any]:
    """Return what a servo says of itself; "broken" where its answers are no answers."""
    board = servo.model_number == OPENCR
    registers: Mapping[str, Register] = {VOLTAGE.name: VOLTAGE} if board else bus.family.registers
    read: dict[str, int | None] = dict.fromkeys(REGISTERS)
    broken = False
    bus.port.baud = servo.baud
    for name in REGISTERS:
        try:
            if register := registers.get(name):
                read[name] = bus.read(servo.id, register)
        except CorruptAnswerError:
            broken = True
        except HardwareError:
            continue
    volts, heat, error = (read[name] for name in REGISTERS)
    return {
        "id": servo.id,
        "model": "OpenCR" if board else servo.model,
        "firmware": servo.firmware,
        "voltage_v": None if volts is None else round(0.1 * volts, 1),
        "temperature_c": heat,
        "error": ", ".join(bus.family.explain(error)) if error else "",
        "broken": broken,
    }
