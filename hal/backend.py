"""Interfaces of a robot to the control loop: implemented by servo buses, the twin and mocks."""

from collections.abc import Mapping
from typing import Protocol, runtime_checkable

from windup.hal.command import JointCommand
from windup.hal.joints import Flags, Joints
from windup.hal.observation import Observation
from windup.hal.torque_loss import Loss
from windup.hal.torque_state import TorqueState


class Clock(Protocol):
    """Clock of a backend: a wall clock sleeps while it waits, the twin's clock steps physics."""

    def now(self) -> float:
        """Return the present time, s."""
        ...

    def wait_until(self, time: float) -> None:
        """Block until the clock reads `time` s; return at once if that has passed."""
        ...


class Backend(Protocol):
    """A set of joints that can be read and commanded.

    Order of calls: `connect`, `configure`, any number of `read` and `write`, `disconnect`.
    `read` is `request` (send, do not wait) followed by `collect` (wait for the answers), so that
    the bus can transfer bytes while the controller computes.
    """

    @property
    def joints(self) -> Joints:
        """The joints, in MJCF order."""
        ...

    @property
    def clock(self) -> Clock:
        """The clock that all times of this backend refer to."""
        ...

    def connect(self) -> None:
        """Open ports and other resources. Nothing moves."""
        ...

    def configure(self) -> None:
        """Apply the settings that the stack relies on. Nothing moves."""
        ...

    def request(self) -> None:
        """Request the state of every joint, without waiting for it."""
        ...

    def collect(self) -> Observation:
        """Wait for the state last requested and return it."""
        ...

    def read(self) -> Observation:
        """Return the present state: `request` followed by `collect`."""
        ...

    def write(self, command: JointCommand) -> JointCommand:
        """Send a command and return the command that was really applied to the joints."""
        ...

    def set_torque(self, on: bool) -> TorqueState:
        """Switch the torque of all joints on or off and return the state that was read back."""
        ...

    def disconnect(self) -> None:
        """Release the resources that `connect` opened."""
        ...


@runtime_checkable
class Rearmable(Protocol):
    """A backend whose port may disappear (adapter unplugged) and come back."""

    def rearm(self) -> TorqueState:
        """Switch torque on at the present pose after a port was lost; return what was read back.

        Raises:
            PortError: A port is still missing.
        """
        ...


@runtime_checkable
class TorqueWatched(Protocol):
    """A backend that detects joints that lost their torque; joints of the twin never do."""

    @property
    def lost(self) -> Mapping[str, str]:
        """Maps the URL of each lost port to a description of the failure."""
        ...

    @property
    def lost_joints(self) -> Mapping[str, Loss]:
        """Maps joint name to the loss, for joints that lost their torque since they were armed."""
        ...

    @property
    def doubtful_joints(self) -> Mapping[str, str]:
        """Maps joint name to the remedy, for joints whose torque state is unknown."""
        ...


@runtime_checkable
class HealthReader(Protocol):
    """A backend that reads supply voltage and temperature less often than joint positions."""

    def read_health(self) -> None:
        """Read supply and temperature of every joint now; the next observation contains them."""
        ...


@runtime_checkable
class BusHealth(Protocol):
    """Error counters and servo alerts of a backend on a bus; the twin does not have them."""

    @property
    def alert_kinds(self) -> tuple[str, ...]:
        """All kinds of alert that a servo can report."""
        ...

    @property
    def alerts(self) -> dict[str, tuple[str, ...]]:
        """Maps joint name to the alerts that its servo reports."""
        ...

    @property
    def clamps(self) -> Mapping[str, int]:
        """Maps each clamp of the driver to the count of commands it changed; the keys are fixed."""
        ...

    def bus_errors(self) -> Mapping[str, int]:
        """Return the number of errors so far by kind; the keys are fixed."""
        ...


@runtime_checkable
class ClampReporter(Protocol):
    """A backend that reports which joints its last command was changed at, and by what."""

    @property
    def clamp_bits(self) -> Flags | None:
        """(n,) bits of the clamps in the order of `BusHealth.clamps`; None if none acted."""
        ...
