"""A backend of XM430 servos on one fake wire."""

from math import pi

from tests.hal.fake_bus import FakeSerial, fake_port
from windup.hal.families import servo_model
from windup.hal.imu.opencr import OpenCr
from windup.hal.joints import Joint, Joints
from windup.hal.servo_bus.servo_backend import BusPort, ServoBackend
from windup.hal.servos.servo_model import ServoMount

XM430 = servo_model("XM430-W350")
COUNT = 2.0 * pi / 4096


def joints_of(n: int, reach: float = 1.5) -> Joints:
    return Joints(tuple(Joint(f"j{i}", -reach, reach, 18.876, 0.85) for i in range(n)))


class Robot:
    """n joints on one bus, odd ones mounted backwards, and the fake wire behind them."""

    def __init__(self, n: int = 4, board: OpenCr | None = None, watchdog: float = 0.2) -> None:
        extra = [board.id] if board else []
        self.serial, port = fake_port([*range(1, n + 1), *extra])
        self.mounts = [
            ServoMount(XM430, "body", i + 1, -1 if i % 2 else 1, 2048, 1.0) for i in range(n)
        ]
        self.backend = ServoBackend(
            joints_of(n),
            self.mounts,
            {"body": BusPort("fake://bus", 1_000_000)},
            board=board,
            watchdog=watchdog,
            opener=lambda url, baud: port,
        )
        if board:
            self.serial.memory[board.id] = bytearray(256)
            self.serial.put(board.id, 24, 1, 1)
        self.backend.connect()

    def up(self) -> "Robot":
        self.backend.configure()
        return self


def written_registers(serial: FakeSerial) -> set[tuple[int, int]]:
    return {(id, start) for id, start, _ in serial.written}
