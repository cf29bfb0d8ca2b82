"""Scans a port for servos at all baud rates, and for other answers."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from windup.hal.bus.bus import FIRST, Bus, ScannedServo
from windup.hal.errors import CorruptAnswerError, HardwareError
from windup.hal.families import DYNAMIXEL_1, DYNAMIXEL_X, Family, families
from windup.hal.imu.opencr import MODEL_NUMBER as OPENCR
from windup.hal.imu.opencr import VOLTAGE
from windup.hal.port.port import Port
from windup.hal.registers import Register
from windup.tools.bringup.raw_answers import InvalidAnswer, invalid_answers, is_echo

SLOW: Final = 57_600
"""Assumed baud rate behind a bridge that hides its own: answers may take as long as at this one."""
REGISTERS: Final = ("present_voltage", "present_temperature", "hardware_error")
"""Registers that are read from each servo found."""


@dataclass
class Survey:
    """The results of scanning a port.

    Args:
        port: The port; its baud rate is restored.
        joints: Names of the expected joints by servo id.

    Attributes:
        servos: A row of registers for each servo.
        unknown: Servos of unknown models: id, baud, and the content of the model number register,
            by the name of each family with a register at that address.
        protocol_1: Servos of the X series that use protocol 1: id, baud and model.
        invalid: Other answers, with the baud rate and the family that was scanned for.
    """

    port: Port
    joints: dict[int, str]
    servos: list[dict[str, Any]] = field(default_factory=list)
    unknown: list[dict[str, Any]] = field(default_factory=list)
    protocol_1: list[dict[str, Any]] = field(default_factory=list)
    invalid: list[tuple[int, Family, InvalidAnswer]] = field(default_factory=list)

    @property
    def duplicate_ids(self) -> list[int]:
        """Ids from which only broken answers come, or broken ones after a valid ping."""
        ids = {one.id for _, _, one in self.invalid if one.id is not None and not one.whole}
        return sorted(ids | {row["id"] for row in self.servos if row["broken"]})

    @property
    def echo(self) -> bool:
        """Whether the adapter echoes the bytes that it sends."""
        return self.port.echoes or any(is_echo(one.data) for _, _, one in self.invalid)

    def update(self, baud: int | None, begin: Callable[[str], None]) -> None:
        """Scan for servos of every family.

        Args:
            baud: The only baud rate to scan; None: all that each family supports.
            begin: Called with a description before each family and baud rate.
        """
        before = self.port.baud
        others: dict[tuple[int | None, int], dict[str, int]] = {}
        try:
            for family, rate in scan_targets(self.port, baud):
                begin(f"{family.name}, {rate} baud" if self.port.has_baud else family.name)
                for servo in self._ask(family, rate):
                    shown = rate if self.port.has_baud else None
                    if servo.model_number in (*family.numbers, OPENCR) or not family.protocol.weak:
                        self._add(Bus(self.port, family), servo, shown)
                    else:
                        others.setdefault((shown, servo.id), {})[family.name] = servo.model_number
                if self.echo and not self.port.echoes:
                    break  # with an echo no answer can be interpreted
        finally:
            self.port.baud = before
        # Several families use protocol 1: a servo that answers one of them answers all.
        known = {(row["baud"], row["id"]) for row in self.servos}
        for (shown, id), numbers in others.items():
            model = DYNAMIXEL_X.numbers.get(numbers.get(DYNAMIXEL_1.name, 0))
            if model is not None:
                self.protocol_1.append({"id": id, "baud": shown, "model": model})
            elif (shown, id) not in known:
                self.unknown.append({"id": id, "baud": shown, "numbers": numbers})

    def _ask(self, family: Family, rate: int) -> list[ScannedServo]:
        """Return the servos of a family that answer; store all other answers."""
        bus, self.port.baud = Bus(self.port, family), rate
        bus.measure_adapter(FIRST)
        before = self.port.received
        found = bus.scan([rate])
        more = self.port.received - before - family.protocol.scan_bytes * len(found)
        if more > 0:
            self.port.baud = rate
            self.invalid += [(rate, family, one) for one in invalid_answers(self.port, family)]
        return found

    def _add(self, bus: Bus, servo: ScannedServo, shown: int | None) -> None:
        if servo.model_number not in (*bus.family.numbers, OPENCR):
            numbers = {bus.family.name: servo.model_number}
            self.unknown.append({"id": servo.id, "baud": shown, "numbers": numbers})
            return
        self.servos.append(_describe(bus, servo) | {"baud": shown})
        self.servos[-1]["joint"] = self.joints.get(servo.id, "")


def scan_targets(port: Port, baud: int | None = None) -> Iterator[tuple[Family, int]]:
    """Yield the families and baud rates to scan: every family at all of its rates, or at one.

    Behind a bridge with a fixed baud rate that is one per family. Protocol 1 is also scanned for at
    the baud rates of the X series, which may be set to it.
    """
    for family in families():
        if not port.has_baud:
            yield family, SLOW
            continue
        bauds = [*family.bauds]
        if family is DYNAMIXEL_1:
            bauds += [rate for rate in DYNAMIXEL_X.bauds if rate not in family.bauds]
        yield from ((family, rate) for rate in bauds if baud in (None, rate))


def _describe(bus: Bus, servo: ScannedServo) -> dict[str, Any]:
    """Return a row with a servo's registers; "broken" if reading one gave a corrupt answer."""
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
