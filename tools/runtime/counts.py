"""What can become of the goals of a client, each with a name and a counter."""

from enum import IntEnum


class Count(IntEnum):
    """A count; its value is its place in the board."""

    RECEIVED = 0
    """Goals that came."""
    REPLACED = 1
    """Goals that a newer one replaced before the loop read them."""
    NOT_JSON = 2
    """Lines that are no message of the protocol, such as one with NaN in it."""
    NOT_FINITE = 3
    """Goals with an infinite number."""
    WRONG_LENGTH = 4
    """Goals for another number of joints."""
    NO_LEASE = 5
    """Goals of clients that do not have the lease."""
    NOT_READY = 6
    """Goals that came while torque was off, or before the robot had made its first motion."""
    LIMITED = 7
    """Goals with a joint beyond its limits, which was clamped."""
    STEPPED = 8
    """Ticks in which a joint's way to its goal was clamped to its largest step."""
    SILENT = 9
    """Times that goals did not come for the deadman time, so that the robot held."""

    @property
    def words(self) -> str:
        """Name for people and in JSON, such as "not_json"."""
        return self.name.lower()


FIRST_OF_LOOP = Count.NOT_READY
"""From here on the loop counts, before it the broker: each counter has one writer."""
