"""Configuration of protocol 1: Dynamixel through dynamixel-sdk, Feetech through feetech-servo-sdk.

Both run on `SdkPort`: on a `Port` and its clock, with input discarded before each request
(feetech-servo-sdk flushes output instead). Parts of feetech-servo-sdk that are not used: its
conversion of bytes to words, because its byte order is a global of the process; and its grouped
reads, which mix old and new values after a failure. Both SDKs return the checksum as data if an
answer is too short, and dynamixel-sdk 4.1.0 cannot do a bulk read in protocol 1 (TypeError). So
they are used only to transmit whole packets, one servo at a time.
"""

from collections.abc import Sequence
from typing import Any

from dynamixel_sdk.protocol1_packet_handler import Protocol1PacketHandler
from scservo_sdk import COMM_RX_TIMEOUT
from scservo_sdk.protocol_packet_handler import protocol_packet_handler

from windup.hal.errors import ServoRejectionError, UsageError
from windup.hal.families.configurator import ATTEMPTS, ServoConfigurator
from windup.hal.port.port import Port
from windup.hal.protocols.protocol1 import Instruction
from windup.hal.registers import Register

REFUSALS = {
    1: "says the goal is beyond its angle limits",
    3: "says the value is out of range",
    4: "received a wrong checksum",
    6: "does not know the instruction",
}
"""Bits of a Dynamixel's error byte that reject an instruction; the others report its health."""


class Protocol1Configurator(ServoConfigurator):
    """Base class of the configurators of both makers.

    Args:
        port: The port.
        packets: The SDK's packet handler.
        model_number: The register of the model number.
    """

    def __init__(self, port: Port, packets: Any, model_number: Register) -> None:
        super().__init__(port, packets)
        self._model_number = model_number

    def ping(self, id: int, attempts: int = ATTEMPTS) -> int:
        """Return the model number of servo `id`, read after a ping, whose answer lacks it."""
        self._instruct(id, Instruction.PING, attempts)
        register = self._model_number
        return register.decode(self.read(id, register.address, register.size))

    def read(self, id: int, address: int, size: int) -> bytes:
        """Return `size` bytes at `address`."""

        def call() -> tuple[bytes, int, int]:
            request = [0, 0, id, 4, int(Instruction.READ), address, size, 0]
            packet, result, error = self._packets.txRxPacket(self._port, request)
            return bytes(packet or b"")[5:-1], result, error

        data, _ = self._ask(id, call, size)
        return bytes(data)

    def reboot(self, id: int) -> None:
        """Raise UsageError: protocol 1 has no reboot instruction."""
        raise UsageError(
            f"id {id} on {self._port.port.url} cannot be rebooted from here; "
            "switch its power off and on"
        )

    def factory_reset(self, id: int, keep: int) -> None:
        """Reset a servo; protocol 1 has no choice of `keep`: the servo decides what it keeps."""
        self._instruct(id, Instruction.FACTORY_RESET, attempts=1)

    def reset_turns(self, id: int) -> None:
        """Reset the multi-turn count of a Feetech servo."""
        self._instruct(id, Instruction.RESET_TURNS)

    def _instruct(self, id: int, instruction: Instruction, attempts: int = ATTEMPTS) -> None:
        """Send an instruction without parameters and wait for the answer."""

        def call() -> tuple[None, int, int]:
            packet = [0, 0, id, 2, int(instruction), 0]
            _, result, error = self._packets.txRxPacket(self._port, packet)
            return None, result, error

        self._ask(id, call, 0, attempts)

    def _size(self, packet: Sequence[int]) -> int:
        """Return the number of parameters of a status packet from the SDK."""
        return packet[3] - 2

    def _check(self, id: int, error: int) -> None:
        """Do nothing: the error byte of a Feetech reports health only, never a rejection."""


class Dynamixel1Configurator(Protocol1Configurator):
    """Configuration of Dynamixel AX and MX."""

    def __init__(self, port: Port, model_number: Register) -> None:
        super().__init__(port, Protocol1PacketHandler(), model_number)

    def _check(self, id: int, error: int) -> None:
        if no := [what for bit, what in REFUSALS.items() if error >> bit & 1]:
            raise ServoRejectionError(f"id {id} on {self._port.port.url} {' and '.join(no)}")


class FeetechConfigurator(Protocol1Configurator):
    """Configuration of Feetech STS, SMS and SCS."""

    timed_out = COMM_RX_TIMEOUT

    def __init__(self, port: Port, model_number: Register) -> None:
        super().__init__(port, protocol_packet_handler(), model_number)
