"""The buttons of an OpenCR as a stop: told from the bytes that come with the IMU anyway."""

from collections.abc import Iterable

from windup.hal.servo_bus.bus_connection import BusConnection


class StopButton:
    """Which buttons are down, and which has been pressed.

    The board itself ignores bounces shorter than 30 ms, and answers are checked by a CRC, so one
    answer that says so is enough.

    Attributes:
        held: Names of the buttons that were down when the board last answered.
        pressed: Name of the first button that went down since torque was last switched on, or None.
    """

    def __init__(self) -> None:
        self.held: tuple[str, ...] = ()
        self.pressed: str | None = None

    def update(self, links: Iterable[BusConnection]) -> None:
        """Take in the last answer of the board, if it was fresh."""
        for link in links:
            line = link.line
            if line.imu_fresh and line.board is not None and line.imu is not None:
                down = line.board.buttons(line.imu)
                if down != self.held:
                    new = [name for name in down if name not in self.held]
                    self.pressed = self.pressed or next(iter(new), None)
                    self.held = down

    def forget(self) -> None:
        """Wait for a new press, since torque comes on; a button that is down already is none."""
        self.pressed = None
