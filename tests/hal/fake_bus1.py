"""Scripted servos of protocol 1 on the fake wire: STS, SCS, AX, MX; plain bytes, few rules."""

from tests.hal.fake_bus import FakeSerial, VirtualClock
from windup.hal.families import family_of, servo_model
from windup.hal.port.port import Port
from windup.hal.protocols import protocol1
from windup.hal.servos.servo_model import ServoModel

STS = servo_model("STS3215-7.4V")
SCS = servo_model("SCS0009")
AX = servo_model("AX-12A")
MX = servo_model("MX-28")


class FakeSerial1(FakeSerial):
    """Attributes: `models` by id, `saved` writes that reached an open EEPROM."""

    def __init__(self, models: dict[int, ServoModel], clock: VirtualClock | None = None) -> None:
        super().__init__([], clock)
        self.models = models
        self.knows_sync = self.knows_bulk = True
        self.saved: list[tuple[int, int, bytes]] = []
        self.memory = {id: bytearray(128) for id in models}
        self.error = dict.fromkeys(models, 0)
        for id, model in models.items():
            self.set(id, "model_number", model.model_number)
            self.set(id, "firmware_version", 3)
            self.set(id, "id", id)
            self.set(id, "return_delay", 250)
            self.set(id, "status_return_level", 1 if model.name[0] == "S" else 2)
            self.set(id, "present_position", model.middle)
            self.set(id, "present_voltage", 74)
            self.set(id, "present_temperature", 35)
            self.set(id, "max_position_limit", model.last_count)
            if "phase" in family_of(model.name).table(model.name):
                self.set(id, "phase", 0b1_1000)
                self.set(id, "lock", 1)

    def set(self, id: int, name: str, counts: int) -> None:
        register = family_of(self.models[id].name).table(self.models[id].name)[name]
        at = register.address
        self.memory[id][at : at + register.size] = register.encode(counts)

    def show(self, id: int, name: str) -> int:
        register = family_of(self.models[id].name).table(self.models[id].name)[name]
        at = register.address
        return register.decode(bytes(self.memory[id][at : at + register.size]))

    def _answer(self, data: bytes) -> bytes:
        if data[:2] != protocol1.HEADER or sum(data[2:]) & 0xFF != 0xFF:
            return b""
        id, kind, body = data[2], data[4], data[5:-1]
        if kind == protocol1.Instruction.SYNC_READ and self.knows_sync:
            return b"".join(self._status(each, body[0], body[1]) for each in body[2:])
        if kind == protocol1.Instruction.BULK_READ and self.knows_bulk:
            return self._bulk(body[1:])
        if kind == protocol1.Instruction.SYNC_WRITE:
            width = body[1] + 1
            for at in range(2, len(body), width):
                self._store(body[at], body[0], body[at + 1 : at + width])
        return self._single(id, kind, body) if id in self.memory else b""

    def _single(self, id: int, kind: int, body: bytes) -> bytes:
        if kind == protocol1.Instruction.READ:
            return self._status(id, body[0], body[1])
        if kind == protocol1.Instruction.WRITE:
            self._store(id, body[0], body[1:])
            if body[0] == self._id_address(id):
                self.memory[body[1]] = self.memory.pop(id)
                self.models[body[1]], self.error[body[1]] = self.models[id], 0
                return protocol1.status(id)
        return self._reply(id, b"")

    def _id_address(self, id: int) -> int:
        return family_of(self.models[id].name).registers["id"].address

    def _store(self, id: int, start: int, data: bytes) -> None:
        lock = family_of(self.models[id].name).registers.get("lock") if id in self.models else None
        if lock is not None and start < 40 and self.memory[id][lock.address] == 0:
            self.saved.append((id, start, data))
        if lock is not None and start == 40 and data == b"\x80":
            self.set(id, "homing_offset", self.show(id, "present_position") - 2048)
            self.set(id, "present_position", 2048)
            return
        super()._store(id, start, data)

    def _bulk(self, rows: bytes) -> bytes:
        """Each waits for the one before it; behind a missing one all is quiet."""
        answer = b""
        for at in range(0, len(rows), 3):
            size, id, start = rows[at : at + 3]
            if not (part := self._status(id, start, size)):
                break
            answer += part
        return answer

    def _reply(self, id: int, params: bytes) -> bytes:
        if id not in self.memory or id in self.silent:
            return b""
        return self.spoil(id, protocol1.status(id, params, self.error[id]))


def fake_port1(
    models: dict[int, ServoModel], clock: VirtualClock | None = None
) -> tuple[FakeSerial1, Port]:
    serial = FakeSerial1(models, clock)
    return serial, Port(serial, "fake://bus")
