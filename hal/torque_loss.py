"""Descriptions of how a joint lost its torque, with a remedy for each."""

from collections.abc import Mapping
from typing import NamedTuple

from windup.hal.errors import TorqueLostError


class Loss(NamedTuple):
    """Cause of a loss of torque, and its remedy.

    Attributes:
        cause: The cause; "{servo}" is replaced by the servo or servos concerned.
        remedy: What the user should do.
    """

    cause: str
    remedy: str

    def __str__(self) -> str:
        return self.cause.format(servo="its servo")


def restart_loss(volts: float) -> Loss:
    """Return the loss for a servo that restarted; `volts` is the lowest supply read, V, or NaN."""
    seen = "" if volts != volts else f" (lowest supply that was read: {volts:.1f} V)"
    return Loss(
        "{servo} restarted" + seen,
        "check battery, supply and connectors, then start again",
    )


def shutdown_loss(errors: tuple[str, ...]) -> Loss:
    """Return the loss for a servo whose own protection (hardware error) switched torque off."""
    return Loss(
        "{servo} shut down: " + ", ".join(errors),
        "remove the cause, then switch the servos' power off and on",
    )


def reduced_torque_loss(errors: tuple[str, ...]) -> Loss:
    """Return the loss for a servo whose own protection has reduced its torque."""
    return Loss(
        "{servo} has reduced its torque: " + ", ".join(errors),
        "remove the cause, then start again",
    )


SWITCHED_OFF = Loss(
    "another program switched it off", "end the other program on the bus, then start again"
)
UNEXPLAINED = Loss(
    "{servo} or another program switched it off",
    "check supply, load and temperature, and that no other program uses the bus",
)
UNPLUGGED = Loss(
    "the port was disconnected, and torque was switched off when it came back",
    "check the cable of the adapter, then start again",
)
SILENT = "check its cable and power, then run `windup health`"
"""Remedy for a servo that does not answer."""


def torque_lost(losses: Mapping[str, Loss]) -> TorqueLostError:
    """Return an error that lists the joints, grouped by how they lost their torque."""
    alike: dict[Loss, list[str]] = {}
    for name, loss in losses.items():
        alike.setdefault(loss, []).append(name)
    return TorqueLostError("; ".join(_sentence(loss, names) for loss, names in alike.items()))


def _sentence(loss: Loss, names: list[str]) -> str:
    servo, its = ("its servo", "its") if len(names) == 1 else ("their servos", "their")
    cause = loss.cause.format(servo=servo)
    return f"{', '.join(names)} lost {its} torque: {cause}; {loss.remedy}"
