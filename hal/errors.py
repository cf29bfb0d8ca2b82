"""All exceptions of the stack, with one base class and an exit status for the command line.

Messages are one line for the person at the robot: what happened, which joint or key, what would
be right, what to run next.
"""

import difflib
from collections.abc import Iterable

MOST_SUGGESTED = 3
"""More names than these that begin with an unknown one say little: the most similar does."""


class WindupError(Exception):
    """Base class of all errors raised by Windup.

    Attributes:
        exit_status: 1 the run failed, 2 usage or configuration (nothing moved), 3 bus or hardware.
        torque_off_at_once: Whether torque goes off at once, whatever the stop policy.
    """

    exit_status = 1
    torque_off_at_once = False


class ConfigError(WindupError):
    """A file is invalid: unknown key, wrong type, value out of range, broken cross-reference."""

    exit_status = 2


class PluginError(WindupError):
    """An entry point of another distribution cannot be loaded, or is not what its group needs."""

    exit_status = 2


class UsageError(WindupError):
    """A command or call has invalid arguments; nothing has moved."""

    exit_status = 2


class UnknownNameError(UsageError):
    """A name is unknown; the message lists the known names and suggests the likely one."""

    def __init__(self, kind: str, name: str, known: Iterable[str]) -> None:
        self.kind, self.name, self.known = kind, name, tuple(known)
        super().__init__(f"unknown {kind} {name!r}{suggest(name, self.known)}")


class StateMissingError(UsageError):
    """A controller needs a part of the observation that the backend does not provide."""


class UnsafeCommandError(WindupError):
    """The guard rejected a command: it contains NaN or has the wrong shape."""


class ControllerError(WindupError):
    """A controller raised an exception during a run."""


class StaleStateError(WindupError):
    """A servo has not answered for longer than the limits allow."""

    exit_status = 3


class DivergedError(WindupError):
    """The physics of the twin diverged; the simulation cannot continue."""


class PlannerError(WindupError):
    """The step planner process could not start, failed, or has exited."""


class OutputError(WindupError):
    """A result cannot be written; the work itself has been completed."""


class TelemetryError(WindupError):
    """A telemetry ring cannot be created, does not exist, or has another version."""

    exit_status = 2


class HardwareError(WindupError):
    """A port, a bus or a servo failed."""

    exit_status = 3


class PortError(HardwareError):
    """A port cannot be opened, or has disappeared."""


class NoAnswerError(HardwareError):
    """A servo did not answer a request before the deadline.

    Attributes:
        extra_bytes: Number of bytes that were received but did not belong to its answer.
    """

    def __init__(self, message: str, extra_bytes: int = 0) -> None:
        super().__init__(message)
        self.extra_bytes = extra_bytes


class CorruptAnswerError(HardwareError):
    """Bytes came, but no frame with a valid checksum: noise, wrong baud rate, or duplicate id."""


class TorqueOnError(HardwareError):
    """Torque was switched off, but a joint read back as on."""


class TorqueUnknownError(HardwareError):
    """Torque was switched off, but a joint could not be read back: it may be on or off."""


class MonitoredLimitError(HardwareError):
    """A monitored quantity reached the level at which the robot stops.

    Attributes:
        kind: Kind of the finding, as in the warnings that preceded it.
    """

    def __init__(self, message: str, kind: str = "") -> None:
        super().__init__(message)
        self.kind = kind


class TorqueLostError(HardwareError):
    """A joint lost its torque, and this stack did not switch it off."""


class UnhealthyError(MonitoredLimitError):
    """A joint is too hot, has a wrong supply voltage, is loaded for too long, or is blocked."""


class ImuError(MonitoredLimitError):
    """The IMU is silent, frozen or wrong, and the robot balances with it."""


class GuardianError(HardwareError):
    """The guardian process, which stops the robot if this process dies, has died or hangs."""


class FirstMotionError(HardwareError):
    """A joint did not follow in the first motion after torque enable; the robot goes limp."""

    torque_off_at_once = True


class PostureError(UsageError):
    """The robot's posture does not allow the requested motion; nothing has moved."""


class ServoRejectionError(HardwareError):
    """A servo rejected an instruction: its status packet carries an error."""


def suggest(name: str, known: Iterable[str]) -> str:
    """Return "; did you mean ...? known: ..." for an unknown `name`.

    >>> suggest("opp3", ["human", "op3"])
    "; did you mean 'op3'? known: human, op3"

    Names that begin with `name` come first:

    >>> suggest("A12", ["A13", "A12-7V", "A12-12V"])
    "; did you mean 'A12-12V' or 'A12-7V'? known: A12-12V, A12-7V, A13"
    """
    names = sorted(known)
    close = _begun_by(name, names) or _similar(name, names)
    hint = f"; did you mean {' or '.join(map(repr, close))}?" if close else ";"
    return f"{hint} known: {', '.join(names) or 'none'}"


def _begun_by(name: str, names: list[str]) -> list[str]:
    """Return the few of `names` that are `name` and something more."""
    longer = [each for each in names if name and each.casefold().startswith(name.casefold())]
    return longer if len(longer) <= MOST_SUGGESTED else []


def _similar(name: str, names: list[str]) -> list[str]:
    """Return the most similar of `names` in a list, whatever the case; none if none is near."""
    folded = {each.casefold(): each for each in names}
    close = difflib.get_close_matches(name.casefold(), folded, n=1, cutoff=0.5)
    return [folded[each] for each in close]
