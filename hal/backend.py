"""What every robot looks like to the loop: a port full of servos, a twin, or a mock."""

from collections.abc import Mapping
from typing import Protocol, runtime_checkable

from windup.hal.command import JointCommand
from windup.hal.joints import Joints
from windup.hal.observation import Observation
from windup.hal.torque_loss import Loss
from windup.hal.torque_state import TorqueState


class Clock(Protocol):
    """Time belongs to the backend: the wall sleeps, the twin steps physics."""

    def now(self) -> float:
        """Return the time, s."""
        ...

    def wait_until(self, time: float) -> None:
        """Return when it is `time` s; at once if that has passed."""
        ...


class Backend(Protocol):
    """Joints that can be read and commanded.

    The life of a backend: `connect`, `configure`, any number of `read` and `write`, `disconnect`.
    `read` is `request` (ask, do not wait) followed by `collect` (wait for the answers), so that a
    bus can carry bytes while the controller computes.
    """

    @property
    def joints(self) -> Joints:
        """The joints, in MJCF order."""
        ...

    @property
    def clock(self) -> Clock:
        """The clock that this backend lives on."""
        ...

    def connect(self) -> None:
        """Open what has to be opened. Nothing moves."""
        ...

    def configure(self) -> None:
        """Assert the settings that the stack relies on. Nothing moves."""
        ...

    def request(self) -> None:
        """Ask every joint for its state."""
        ...

    def collect(self) -> Observation:
        """Return the state last asked for."""
        ...

    def read(self) -> Observation:
        """Return the present state: `request` and `collect`."""
        ...

    def write(self, command: JointCommand) -> JointCommand:
        """Send a command and return what the joints really got."""
        ...

    def set_torque(self, on: bool) -> TorqueState:
        """Switch the torque of all joints and return what was read back."""
        ...

    def disconnect(self) -> None:
        """Give back what `connect` took."""
        ...


@runtime_checkable
class Rearmable(Protocol):
    """A backend whose port may go and come back."""

    def rearm(self) -> TorqueState:
        """Switch torque on at the present pose after a port was gone; return what was read back.

        Raises:
            PortError: A port is still gone.
        """
        ...


@runtime_checkable
class TorqueWatched(Protocol):
    """A backend that sees whether its joints still have their torque; a twin's always do."""

    @property
    def lost(self) -> Mapping[str, str]:
        """URL of each port that is gone, to what was seen of it."""
        ...

    @property
    def lost_joints(self) -> Mapping[str, Loss]:
        """Joint name to how it has lost its torque since it was armed."""
        ...

    @property
    def doubtful_joints(self) -> Mapping[str, str]:
        """The joints of which nobody knows whether they have torque, and what to do about each."""
        ...


@runtime_checkable
class HealthReader(Protocol):
    """A backend whose supply and temperature are read less often than its joints move."""

    def read_health(self) -> None:
        """Read supply and temperature of every joint now; the next observation has them."""
        ...


@runtime_checkable
class BusHealth(Protocol):
    """What a backend on a bus can say about the bus and its servos; a twin has neither."""

    @property
    def alert_kinds(self) -> tuple[str, ...]:
        """All that a servo can complain of."""
        ...

    @property
    def alerts(self) -> dict[str, tuple[str, ...]]:
        """Joint name to what its servo complains of."""
        ...

    @property
    def clamps(self) -> Mapping[str, int]:
        """Clamp of the driver's own to the number of commands it changed; always the same names."""
        ...

    def bus_errors(self) -> Mapping[str, int]:
        """Return kind of error to how often it has happened; the kinds are always the same."""
        ...
