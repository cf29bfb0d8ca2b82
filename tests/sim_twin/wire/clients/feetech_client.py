"""A script of somebody who has one of Feetech's SDKs and two servos: ``sts|scs PORT``.

PORT is a path, or the options of a `ServoBus` as JSON, for servos on a virtual clock. Makes every
call of the SDK and prints what it found as JSON. The SDKs have one import name: feetech-servo-sdk
takes the port in each call, ftservo-python-sdk has classes for STS and SCS.
"""

import json
import sys
import time
from collections.abc import Callable
from typing import Any, Literal

import scservo_sdk as sdk

from tests.sim_twin.wire.clients.record import calls, recorded
from windup.tools.testing.servo_bus import ServoBus

IDS = (1, 2)
NEW = hasattr(sdk, "sms_sts")  # ftservo-python-sdk
TORQUE, GOAL, SPEED, POSITION = 40, 42, 46, 56
OK = sdk.COMM_SUCCESS


class Servos:
    """The packets of either SDK; what it is asked for gets the port if it takes one."""

    def __init__(self, family: str, path: str, port_handler: type[Any]) -> None:
        end = int(family == "scs")
        kind = (sdk.scscl if end else sdk.sms_sts) if NEW else type(sdk.PacketHandler(end))
        port, self.port_asked = recorded(port_handler)
        packets, self.asked = recorded(kind)
        self.kind, self.port = kind, port(path)
        self.order: Literal["little", "big"] = "big" if end else "little"
        self.packets = packets(self.port) if NEW else packets()

    def __call__(self, name: str, *arguments: Any) -> Any:
        before = () if NEW else (self.port,)
        return getattr(self.packets, name)(*before, *arguments)

    def group(self, kind: type, address: int, size: int) -> Any:
        return kind(*(() if NEW else (self.port,)), self.packets, address, size)

    def bytes(self, value: int) -> list[int]:
        return list(value.to_bytes(2, self.order))

    def uncalled(self) -> list[str]:
        return sorted((calls(self.kind) - self.asked) | (calls(sdk.PortHandler) - self.port_asked))


def until(ask: Callable[[], Any], good: Callable[[Any], bool]) -> Any:
    """Ask until the answer is good, or a busy machine has had its time."""
    end = time.monotonic() + 30.0
    while not good(answer := ask()) and time.monotonic() < end:
        pass
    return answer


def there(servos: Servos, goal: int, id: int = 1) -> int:
    """Return where a servo stands once it is at its goal."""
    return int(
        until(
            lambda: servos("read2ByteTxRx", id, POSITION),
            lambda got: got[1:] == (0, 0) and abs(got[0] - goal) < 8,
        )[0]
    )


def open_port(servos: Servos, path: str) -> dict[str, Any]:
    port = servos.port
    port.setPortName(path)
    opened = port.openPort() and port.setBaudRate(1_000_000)
    port.setPacketTimeoutMillis(0)
    return {
        "opened": [opened, port.getPortName() == path, port.getBaudRate()],
        "idle": port.getBytesAvailable(),
        "late": until(port.isPacketTimeout, bool),
        "model": until(lambda: servos("ping", 1), lambda got: got[1:] == (0, 0))[0],
        "words": [servos.packets.getTxRxResult(OK), servos.packets.getRxPacketError(32)],
        "version": servos.packets.getProtocolVersion(),
    }


def read(servos: Servos) -> dict[str, Any]:
    """Read the model number, or the position and the speed, in each way."""
    said: dict[str, Any] = {}
    for size, address in ((1, TORQUE), (2, POSITION), (4, POSITION)):
        value, *error = servos(f"read{size}ByteTxRx", 1, address)
        servos(f"read{size}ByteTx", 1, address)
        said[f"read{size}"] = [servos(f"read{size}ByteRx", 1)[0], value, error]
    servos("readTx", 1, POSITION, 2)
    said["bytes"] = [servos("readRx", 1, 2)[0], servos("readTxRx", 1, POSITION, 2)[0]]
    servos("syncReadTx", POSITION, 2, list(IDS), 2)
    if NEW:
        said["sync"] = len(servos("syncReadRx", 2, 2)[1]) // 8  # frames
    else:
        said["sync"] = [servos("readRx", id, 2)[1] for id in IDS].count(OK)
    return said


def write(servos: Servos) -> dict[str, Any]:
    """Write in each way; each but the answered ones leaves an answer, which is taken away."""
    said: dict[str, Any] = {"torque": [servos("write1ByteTxRx", 1, TORQUE, 1)]}
    servos("write1ByteTxOnly", 1, TORQUE, 0)
    servos("rxPacket")
    said["torque"].append(servos("read1ByteTxRx", 1, TORQUE)[0])
    for way, speed in (("TxRx", 700), ("TxOnly", 800)):
        servos(f"write2Byte{way}", 1, SPEED, speed)
        servos("rxPacket") if way == "TxOnly" else None
        said.setdefault("speeds", []).append(servos("read2ByteTxRx", 1, SPEED)[0])
    for way, goal in (("TxRx", 400), ("TxOnly", 600)):
        servos(f"write4Byte{way}", 1, GOAL, goal)  # and no time
        servos("rxPacket") if way == "TxOnly" else None
        said.setdefault("goals", []).append(there(servos, goal))
    for way, goal in (("TxRx", 450), ("TxOnly", 550)):
        servos(f"write{way}", 1, GOAL, 2, servos.bytes(goal))
        servos("rxPacket") if way == "TxOnly" else None
        said["goals"].append(there(servos, goal))
    for way, goal in (("TxRx", 500), ("TxOnly", 600)):
        servos(f"regWrite{way}", 1, GOAL, 2, servos.bytes(goal))
        servos("rxPacket") if way == "TxOnly" else None
        said.setdefault("waits", []).append(servos("read2ByteTxRx", 1, GOAL)[0] != goal)
        servos("action", sdk.BROADCAST_ID)
        said["goals"].append(there(servos, goal))
    both = [byte for id in IDS for byte in (id, *servos.bytes(550))]
    servos("syncWriteTxOnly", GOAL, 2, both, len(both))
    said["both"] = [there(servos, 550, id) for id in IDS]
    return said


def in_groups(servos: Servos) -> dict[str, Any]:
    """Read and write two servos together, with one put in, taken out and changed."""
    writer, asked_w = recorded(sdk.GroupSyncWrite)
    reader, asked_r = recorded(sdk.GroupSyncRead)
    goals = servos.group(writer, GOAL, 2)
    goals.addParam(3, servos.bytes(0))
    goals.clearParam()
    for id in IDS:
        goals.addParam(id, servos.bytes(0))
        goals.changeParam(id, servos.bytes(500))
    goals.addParam(4, servos.bytes(0))
    goals.removeParam(4)
    said: dict[str, Any] = {"group_write": goals.txPacket()}
    places = servos.group(reader, POSITION, 4)
    for id in (3, *IDS):
        places.addParam(id)
    places.removeParam(3)
    said["group_read"] = until(
        lambda: [places.txRxPacket(), *(places.getData(id, POSITION, 2) for id in IDS)],
        lambda got: got[0] == OK and all(abs(at - 500) < 8 for at in got[1:]),
    )
    found = places.isAvailable(1, POSITION, 2)
    said["available"] = found[0] if isinstance(found, tuple) else found
    places.clearParam()
    said["group_uncalled"] = sorted(
        (calls(sdk.GroupSyncWrite) - asked_w) | (calls(sdk.GroupSyncRead) - asked_r)
    )
    return said


def drive(servos: Servos) -> dict[str, Any]:
    """Move a servo by the calls that only ftservo-python-sdk has."""
    packets, sts = servos.packets, servos.kind.__name__ == "sms_sts"
    name, how = ("PosEx", (2000, 50)) if sts else ("Pos", (0, 1000))
    getattr(packets, f"Write{name}")(1, 700, *how)
    said: dict[str, Any] = {"moving": until(lambda: packets.ReadMoving(1), lambda got: got[0] == 1)}
    said["places"] = [there(servos, 700)]
    getattr(packets, f"SyncWrite{name}")(1, 600, *how)
    packets.groupSyncWrite.txPacket()
    said["places"].append(there(servos, 600))
    getattr(packets, f"RegWrite{name}")(1, 500, *how)
    packets.RegAction()
    said["places"].append(there(servos, 500))
    said["place"] = [packets.ReadPos(1)[0], packets.ReadPosSpeed(1)[0]]
    said["locks"] = [packets.unLockEprom(1), packets.LockEprom(1)]
    packets.unLockEprom(1)
    if sts:
        packets.WheelMode(1)
        packets.WriteSpec(1, -500, 50)
    else:
        packets.PWMMode(1)
        packets.WritePWM(1, -500)
    said["backward"] = until(lambda: packets.ReadSpeed(1), lambda got: got[0] < -300)[0]
    return said


def main(family: str, path: str) -> None:
    if path.startswith("{"):
        with ServoBus(**json.loads(path)) as bus:
            make_every_call(Servos(family, "servos", bus.port_handler("feetech")), "servos")
        return
    sdk.port_handler.LATENCY_TIMER = 2000  # ms, for a busy machine
    make_every_call(Servos(family, path, sdk.PortHandler), path)


def make_every_call(servos: Servos, path: str) -> None:
    said = {**open_port(servos, path), **read(servos), **write(servos)}
    said.update(in_groups(servos))
    if NEW:
        servos.packets.scs_setend(servos.packets.scs_getend())
        said.update(drive(servos))
    servos.port.closePort()
    print(json.dumps({**said, "uncalled": servos.uncalled()}))


if __name__ == "__main__":
    main(*sys.argv[1:])
