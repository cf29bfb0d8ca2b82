"""The buttons of an OpenCR as stop buttons, decoded from the bytes read with the IMU."""

from collections.abc import Iterable

from windup.hal.servo_bus.bus_connection import BusConnection


class StopButton:
    """State of the buttons, and the first press.

    The board debounces its buttons (30 ms), and answers are checked by a CRC, so a single answer
    is sufficient.

    Attributes:
        held: Names of the buttons that were down when the board last answered.
        pressed: Name of the first button that went down since torque was last switched on, or None.
    """

    def __init__(self) -> None:
        self.held: tuple[str, ...] = ()
        self.pressed: str | None = None

    def update(self, links: Iterable[BusConnection]) -> None:
        """Evaluate the last answer of the board, if it is new."""
        for link in links:
            readout = link.readout
            if readout.imu_fresh and readout.board is not None and readout.imu is not None:
                down = readout.board.buttons(readout.imu)
                if down != self.held:
                    new = [name for name in down if name not in self.held]
                    self.pressed = self.pressed or next(iter(new), None)
                    self.held = down

    def reset(self) -> None:
        """Forget earlier presses before torque enable; a button already down is not a new press."""
        self.pressed = None
