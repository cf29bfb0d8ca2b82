"""A ring of two servos, written by hand."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from windup.hal.command import JointCommand
from windup.hal.contacts import ContactSensors
from windup.hal.guard import GuardedBackend, SafetyLimits
from windup.hal.joints import Flags, Joint, Joints
from windup.hal.observation import BaseState, ImuState, JointState, Observation
from windup.hal.telemetry.writer import TelemetryWriter
from windup.hal.torque_state import TorqueState

JOINTS = Joints(tuple(Joint(name, -1.0, 1.0, 10.0, 1.0) for name in ("hip", "knee")))
CONTACTS = ContactSensors(("heel", "toe"), {"foot": ("heel", "toe")})


class Standing:
    """A clock that stands still."""

    def now(self) -> float:
        return 0.0

    def wait_until(self, time: float) -> None:
        pass


@dataclass
class Servos:
    """Two servos on a bus that fails now and then."""

    joints: Joints = JOINTS
    clock: Standing = field(default_factory=Standing)
    alert_kinds: tuple[str, ...] = ("heat", "load")
    alerts: dict[str, tuple[str, ...]] = field(default_factory=dict)
    clamps: dict[str, int] = field(default_factory=lambda: {"goal": 0, "unarmed": 0})
    clamp_bits: Flags | None = None
    errors: dict[str, int] = field(default_factory=lambda: {"no answer": 0, "corrupt": 0})

    def bus_errors(self) -> Mapping[str, int]:
        return self.errors

    def connect(self) -> None: ...
    def configure(self) -> None: ...
    def request(self) -> None: ...
    def disconnect(self) -> None: ...

    def collect(self) -> Observation:
        return observation()

    def read(self) -> Observation:
        return observation()

    def write(self, command: JointCommand) -> JointCommand:
        return command

    def set_torque(self, on: bool) -> TorqueState:
        return TorqueState.known(np.full(2, on))


def observation(time: float = 0.0, whole: bool = True) -> Observation:
    rows = [np.array([k + 0.25, k + 0.5]) for k in range(6)]
    base = BaseState(np.arange(3.0), np.array([1.0, 0, 0, 0]), np.ones(3), np.zeros(3), 0.5)
    imu = ImuState(None, np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.0, 9.81]), 0.004)
    joints = JointState(*rows)
    contacts = np.array([0.0, 7.0])
    return Observation(time, joints, imu if whole else None, contacts, base if whole else None)


def guarded() -> GuardedBackend:
    return GuardedBackend(Servos(), SafetyLimits.of(JOINTS))


def ring(folder: Path, name: str = "duo", rate: float = 1.0) -> TelemetryWriter:
    return TelemetryWriter(name, guarded(), CONTACTS, rate, path=folder / f"{name}.ring")


def write(writer: TelemetryWriter, ticks: range) -> None:
    """Write ticks whose numbers all follow from their number."""
    for k in ticks:
        asked = JointCommand.hold(JOINTS, np.array([0.1, 0.01 * k]))
        writer.record(
            observation(0.1 * k), asked, asked.with_position(np.full(2, k)), 1e-3, 2e-3, k, 0
        )
