"""What a guardian is told when it starts, and the bytes that it hears from then on."""

import msgspec

from windup.hal.guard.limits import StopPolicy

READY = b"r"
"""Guardian to host: the first heartbeat has arrived; torque may come on."""
TICK, FIRST, IDLE, RELEASE, HAND_OVER = b"t", b"f", b"i", b"x", b"h"
"""Host to guardian: a tick of the loop, and one of the first motion after torque came on; alive
between two runs, or switching torque; torque was read back as off; the host has given up its ports
with torque that it could not read."""

SILENCE = {TICK: 0.15, FIRST: 0.15, IDLE: 1.0}
"""How long the guardian waits for the next byte after one of these, s. A robot that only holds its
pose may wait longer: a program between two runs may load a file, or import a package."""


class Charge(msgspec.Struct, frozen=True, kw_only=True):
    """One bus that is looked after.

    Attributes:
        url: Of its port.
        baud: Bits a second.
        servos: Id to model name.
        crouch: Id to the goal position of the robot's crouch, counts; empty without one.
        levels: Id to the temperature, degrees C, and the supply, V, at which a servo that is held
            has to be let go; one without is held whatever it reads.
        names: Id to joint name, for people; empty where nobody knows them.
        extended: Ids of the servos that count many turns.
        latency: How long its adapter holds bytes back, s.
        echoes: Does its adapter give back what it is sent?
        lock: Descriptor of the lock on its adapter, held by host and guardian together.
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


class Order(msgspec.Struct, frozen=True, kw_only=True):
    """What to look after, and what to do when the host dies or is silent.

    Attributes:
        host: Process number of the host.
        policy: What "stop" means for this robot.
        charges: Its buses.
        hold: How long "hold" lasts before torque goes off, s.
    """

    host: int
    policy: StopPolicy
    charges: tuple[Charge, ...]
    hold: float = 60.0
