"""The state of a run, as a code: a robot is in exactly one of these states."""

from enum import IntEnum


class RunState(IntEnum):
    """State of a run; the codes are part of the format of telemetry and of logs."""

    DISCONNECTED = 0
    """No program has the robot's ports open."""
    LIMP = 1
    """Torque is off."""
    HOLDING = 2
    """Torque is on, and the robot keeps its last goals; no controller runs."""
    STANDING = 3
    """A controller runs that has not reported any of the states that follow."""
    WALKING = 4
    """The controller walks."""
    STEPPING = 5
    """The controller takes single steps: against a fall, or from footprint to footprint."""
    FALLING = 6
    """A fall is predicted that cannot be prevented; the robot takes a landing pose."""
    FALLEN = 7
    """The robot lies."""
    RISING = 8
    """The controller gets up."""
    STOPPING = 9
    """The stop policy is being carried out."""
    FAULTED = 10
    """The run ended with an error; the stop policy has been carried out."""

    @property
    def words(self) -> str:
        """Name for people, such as "standing"."""
        return self.name.lower()
