"""Every error of the stack, under one root, each with the exit status it means at the command line.

Messages are one line for the person at the robot: what happened, which joint or key, what would
be right, what to run next.
"""

import difflib
from collections.abc import Iterable


class WindupError(Exception):
    """Root of all errors raised by Windup.

    Attributes:
        exit_status: 1 the run failed, 2 usage or configuration (nothing moved), 3 bus or hardware.
        limp: Whether a robot goes limp for it at once, whatever its stop policy.
    """

    exit_status = 1
    limp = False


class ConfigError(WindupError):
    """A file says something that cannot be: unknown key, wrong type, broken cross-reference."""

    exit_status = 2


class UsageError(WindupError):
    """A command or call with values that cannot work; nothing has moved."""

    exit_status = 2


class UnknownNameError(UsageError):
    """A name that is not there, with the known names and the likely one."""

    def __init__(self, kind: str, name: str, known: Iterable[str]) -> None:
        self.kind, self.name, self.known = kind, name, tuple(known)
        super().__init__(f"unknown {kind} {name!r}{suggest(name, self.known)}")


class StateMissingError(UsageError):
    """A controller needs a part of the observation that this backend does not measure."""


class UnsafeCommandError(WindupError):
    """A command that the guard refuses outright: not a number, or of the wrong shape."""


class ControllerError(WindupError):
    """A controller failed in mid-run with an error of its own."""


class StaleStateError(WindupError):
    """A servo has not answered for longer than the limits allow."""

    exit_status = 3


class DivergedError(WindupError):
    """The twin's physics left the numbers; the simulation cannot go on."""


class PlannerError(WindupError):
    """The process that plans steps could not start, failed, or has died."""


class OutputError(WindupError):
    """A result cannot be written; what was to be done is done."""


class TelemetryError(WindupError):
    """A telemetry ring that cannot be made, is not there, or is of another version."""

    exit_status = 2


class HardwareError(WindupError):
    """A port, a bus or a servo failed."""

    exit_status = 3


class PortError(HardwareError):
    """A port cannot be opened, or went away."""


class NoAnswerError(HardwareError):
    """A servo that was asked said nothing before the deadline.

    Attributes:
        came: How many bytes came that were no answer of its.
    """

    def __init__(self, message: str, came: int = 0) -> None:
        super().__init__(message)
        self.came = came


class CorruptAnswerError(HardwareError):
    """Bytes came, but no frame with a good checksum: noise, a wrong baud rate, an id twice."""


class TorqueOnError(HardwareError):
    """Torque was told to go off, and a joint read back as on."""


class TorqueUnknownError(HardwareError):
    """Torque was told to go off, and a joint could not be read back: it may be on or off."""


class UnwellError(HardwareError):
    """Something that was watched is so unwell that the robot stops.

    Attributes:
        kind: What it is, in the word of the warnings that came before.
    """

    def __init__(self, message: str, kind: str = "") -> None:
        super().__init__(message)
        self.kind = kind


class TorqueLostError(HardwareError):
    """A joint has no torque any more though nobody of ours switched it off."""


class UnhealthyError(UnwellError):
    """A joint is too hot, on the wrong supply, loaded for too long, or blocked."""


class ImuError(UnwellError):
    """The IMU is silent, frozen or wrong, and a robot that balances with it cannot go on."""


class GuardianError(HardwareError):
    """The process that stops the robot when this one dies has died itself, or does not react."""


class FirstMotionError(HardwareError):
    """A joint did not follow in the first motion after torque came on; the robot goes limp."""

    limp = True


class PostureError(UsageError):
    """The robot is in no posture to do what it was to do; nothing has moved."""


class RefusedError(HardwareError):
    """A servo answered that it will not do what it was told."""


def suggest(name: str, known: Iterable[str]) -> str:
    """Return "; did you mean ...? known: ..." for an unknown `name`.

    >>> suggest("opp3", ["human", "op3"])
    "; did you mean 'op3'? known: human, op3"
    """
    names = sorted(known)
    close = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
    hint = f"; did you mean {close[0]!r}?" if close else ";"
    return f"{hint} known: {', '.join(names) or 'none'}"
