"""Messages between host and guardian: the order at the start, and the heartbeat bytes."""

import msgspec

from windup.hal.guard.limits import StopPolicy

READY = b"r"
"""Guardian to host: order and first heartbeat have arrived, so torque may be enabled."""
TICK, FIRST, IDLE, RELEASE, HAND_OVER = b"t", b"f", b"i", b"x", b"h"
"""Host to guardian, in this order: a tick of the loop; a tick of the first motion after torque
enable; alive without a loop (between two runs, or switching torque); torque was read back as off;
the host has closed its ports but torque could not be read back as off."""

MAX_SILENCE = {TICK: 0.15, FIRST: 0.15, IDLE: 1.0}
"""Maximum time from each byte to the next one, s. It is longer while the robot only holds its
pose: a program between two runs may load a file, or import a package."""


class GuardedBus(msgspec.Struct, frozen=True, kw_only=True):
    """One guarded bus.

    Attributes:
        url: URL of its port.
        baud: Baud rate, bit/s.
        servos: Maps id to model name.
        crouch: Maps id to the goal position of the robot's crouch, counts; empty without one.
        levels: Maps id to the temperature, degrees C, and the supply, V, at which a hold ends; a
            servo without an entry is held whatever it reads.
        names: Maps id to joint name, for messages; empty if unknown.
        extended: Ids of the servos in extended (multi-turn) position mode.
        latency: Latency of its adapter, s.
        echoes: Whether its adapter echoes the bytes sent.
        lock: Descriptor of the lock on its adapter, shared by host and guardian; -1 for none.
    """

    url: str
    baud: int
    servos: dict[int, str]
    crouch: dict[int, int] = {}
    levels: dict[int, tuple[float, float]] = {}
    names: dict[int, str] = {}
    extended: tuple[int, ...] = ()
    latency: float = 0.0
    echoes: bool = False
    lock: int = -1


class GuardianOrder(msgspec.Struct, frozen=True, kw_only=True):
    """The guarded buses, and what to do when the host dies or is silent.

    Attributes:
        host: Process id of the host.
        policy: Stop policy of the robot.
        buses: The guarded buses.
        hold: Duration of the policy "hold" before torque goes off, s.
        flag: Path of the host's stop flag; "" without one.
    """

    host: int
    policy: StopPolicy
    buses: tuple[GuardedBus, ...]
    hold: float = 60.0
    flag: str = ""
