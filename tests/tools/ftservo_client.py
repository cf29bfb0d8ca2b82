"""A script of somebody who has ftservo-python-sdk and a duck: ``ftservo_client.py PORT``.

Prints what it found as JSON. What is not answered is asked again.
"""

import json
import sys
import time
from collections.abc import Callable
from typing import Any

import scservo_sdk as sdk

IDS = range(8, 36)
HEAD = 32
OFFSET, TORQUE, LOCK, POSITION = 31, 40, 55, 56


def again(call: Callable[..., Any], *arguments: Any) -> Any:
    """Return the value of a call whose last two results are a status and an error of 0."""
    for _ in range(50):
        *value, status, error = call(*arguments)
        if (status, error) == (0, 0):
            return value[0] if value else None
    raise SystemExit(f"{call.__name__}{arguments}: no answer")


def turn(servos: Any, goal: int) -> tuple[int, int]:
    """Turn the head to `goal`; return its fastest speed and how far it went, counts."""
    before = again(servos.ReadPos, HEAD)
    again(servos.WritePosEx, HEAD, goal, 2000, 50)
    fastest, end = 0, time.monotonic() + 1.5
    while time.monotonic() < end:
        fastest = max(fastest, again(servos.ReadSpeed, HEAD), key=abs)
    return fastest, again(servos.ReadPos, HEAD) - before


def main(path: str) -> None:
    port = sdk.PortHandler(path)
    assert port.openPort()
    assert port.setBaudRate(1_000_000)
    servos = sdk.sms_sts(port)
    found = [(id, servos.ping(id)) for _ in range(2) for id in IDS]
    said: dict[str, Any] = {
        "sdk": sdk.__file__,
        "found": list(
            {id: (id, model) for id, (model, status, _) in found if status == 0}.values()
        ),
    }
    again(servos.write1ByteTxRx, HEAD, TORQUE, 0)
    again(servos.unLockEprom, HEAD)
    locks = [again(servos.read1ByteTxRx, HEAD, LOCK)]
    again(servos.write2ByteTxRx, HEAD, OFFSET, 0)
    before = again(servos.ReadPos, HEAD)
    again(servos.write2ByteTxRx, HEAD, OFFSET, 100 | 1 << 11)
    said["offset"] = before - again(servos.ReadPos, HEAD)
    again(servos.write1ByteTxRx, HEAD, TORQUE, 128)
    said["middle"] = again(servos.ReadPos, HEAD)
    again(servos.LockEprom, HEAD)
    said["lock"] = [*locks, again(servos.read1ByteTxRx, HEAD, LOCK)]
    ways = [turn(servos, 2148), turn(servos, 2048)]
    said["speeds"], said["turned"] = zip(*ways, strict=True)
    for id in (30, 31, HEAD):
        servos.SyncWritePosEx(id, 2048, 1000, 50)
    assert servos.groupSyncWrite.txPacket() == sdk.COMM_SUCCESS
    time.sleep(1.5)
    sync = sdk.GroupSyncRead(servos, POSITION, 4)
    for id in (30, 31, HEAD):
        sync.addParam(id)
    for _ in range(50):
        if sync.txRxPacket() == sdk.COMM_SUCCESS:
            break
    said["sync"] = [sync.getData(id, POSITION, 2) for id in (30, 31, HEAD)]
    print(json.dumps(said))


if __name__ == "__main__":
    main(sys.argv[1])
