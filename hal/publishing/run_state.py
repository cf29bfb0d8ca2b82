"""The state of a run, as a code: a robot is in exactly one of these states."""

from enum import IntEnum


class RunState(IntEnum):
    """State of a run; the codes are part of the format of telemetry and of logs.

    Attributes:
        DISCONNECTED: No program has the robot's ports open.
        LIMP: Torque is off.
        HOLDING: Torque is on, and the robot keeps its last goals; no controller runs.
        STANDING: A controller runs that does not report any of the states that follow.
        WALKING: The controller walks.
        STEPPING: The controller takes single steps, against a fall or from one footprint to the
            next.
        FALLING: A fall is predicted that cannot be prevented; the robot takes a landing pose.
        FALLEN: The robot lies.
        RISING: The controller gets up.
        STOPPING: The stop policy is being carried out.
        FAULTED: The run ended with an error; the stop policy has been carried out.
    """

    DISCONNECTED = 0
    LIMP = 1
    HOLDING = 2
    STANDING = 3
    WALKING = 4
    STEPPING = 5
    FALLING = 6
    FALLEN = 7
    RISING = 8
    STOPPING = 9
    FAULTED = 10

    @property
    def words(self) -> str:
        """Name for people, such as "standing"."""
        return self.name.lower()
