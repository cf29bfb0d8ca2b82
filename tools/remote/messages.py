"""Messages between a client and the runtime: JSON objects, one a line, over a Unix socket.

Every message has a key `type`. Joint arrays are in the order of `Welcome.joints`, in rad.
"""

from typing import Any, Final

import msgspec

PROTOCOL: Final = 1
"""Version of these messages: both sides need the same."""
LONGEST: Final = 1 << 18
"""Maximum length of a line from a client, bytes."""


class Message(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", tag=str.lower):
    """Base class of all messages."""


class Hello(Message, frozen=True, kw_only=True):
    """Client: the first message.

    Attributes:
        protocol: Version of the client's messages.
        version: Version of the client's Windup.
        client: What the client is, for people, such as "windup walk".
        pid: Its process id.
    """

    protocol: int
    version: str
    client: str
    pid: int


class Take(Message, frozen=True, kw_only=True):
    """Client: take the lease, which one client at a time can have."""


class Release(Message, frozen=True, kw_only=True):
    """Client: give the lease back; the robot holds."""


class Run(Message, frozen=True, kw_only=True):
    """Client: run a behaviour, in place of the present one; takes the lease.

    Attributes:
        id: Number that the answers repeat.
        behaviour: Name of the behaviour.
        options: Its options by name.
        arm: Switch torque on again after a stop.
    """

    id: int
    behaviour: str
    options: dict[str, Any] = {}
    arm: bool = False


class Change(Message, frozen=True, kw_only=True):
    """Client: change the walk that goes on; what is None stays.

    Attributes:
        speed: Forward speed, m/s.
        side: Sideways speed, m/s; positive to the left.
        turn: Turn rate, rad/s; positive to the left.
        style: Amounts of styles by name.
    """

    speed: float | None = None
    side: float | None = None
    turn: float | None = None
    style: dict[str, float] = {}


class End(Message, frozen=True, kw_only=True):
    """Client: end the behaviour; the robot comes to rest, if it can, and holds."""


class Goal(Message, frozen=True, kw_only=True):
    """Client: goal of the joints; the newest wins, and holding follows when no other one comes.

    Attributes:
        position: (n,) rad.
    """

    position: tuple[float, ...]


class Down(Message, frozen=True, kw_only=True):
    """Client: end the runtime: rest, torque off, disconnect."""


class Ask(Message, frozen=True, kw_only=True):
    """Client: ask for a `Status`, which repeats the number `id`."""

    id: int = 0


class Welcome(Message, frozen=True, kw_only=True):
    """Runtime: answer to `Hello`.

    Attributes:
        robot: Name of the robot.
        port: URL of its port; None for a twin.
        may_arm: Torque may come on.
        pid: Process id of the runtime.
        version: Version of its Windup.
        joints: Names of the joints.
        rate_hz: Rate of the loop, Hz.
        deadman: Time after the last `Goal` at which the robot holds, s.
    """

    robot: str
    port: str | None
    may_arm: bool
    pid: int
    version: str
    joints: tuple[str, ...]
    rate_hz: float
    deadman: float


class Leased(Message, frozen=True, kw_only=True):
    """Runtime: the client has the lease."""


class Refused(Message, frozen=True, kw_only=True):
    """Runtime: a request is refused, and nothing has moved because of it.

    Attributes:
        message: Why, and what would be right.
        exit_status: That of a command that was refused.
        id: Number of the `Run` that is refused; None for another request.
    """

    message: str
    exit_status: int = 2
    id: int | None = None


class Started(Message, frozen=True, kw_only=True):
    """Runtime: behaviour number `id` has begun."""

    id: int


class Ended(Message, frozen=True, kw_only=True):
    """Runtime: a behaviour has ended.

    Attributes:
        id: Number of its `Run`.
        good: The robot did what was asked.
        reason: Why it ended.
        lines: Text for people.
        result: The numbers, as in the JSON of the command.
        exit_status: That of the command.
    """

    id: int
    good: bool
    reason: str
    lines: tuple[str, ...] = ()
    result: dict[str, Any] = {}
    exit_status: int = 0


class Status(Message, frozen=True, kw_only=True):
    """Runtime: how it is; sent on `Ask`, and when the state changes.

    Attributes:
        state: State of the robot.
        behaviour: Behaviour that runs; "" for none.
        armed: Torque is on.
        ticks: Ticks since the runtime began.
        missed: Ticks that came too late.
        holder: Client that has the lease; "" for none.
        clients: Number of clients.
        counts: Goals by what became of them, with the names of `Count`.
        id: Number of the `Ask` that it answers; None where the state has changed.
    """

    state: str
    behaviour: str
    armed: bool
    ticks: int
    missed: int
    holder: str
    clients: int
    counts: dict[str, int]
    id: int | None = None


FromClient = Hello | Take | Release | Run | Change | End | Goal | Down | Ask
ToClient = Welcome | Leased | Refused | Started | Ended | Status
