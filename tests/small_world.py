"""The smallest robot that shows a rule: five joints, two feet of two sensors, its own clock."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from windup.control.pose_graph.gait import Gait, load_gait
from windup.hal.command import JointCommand
from windup.hal.contacts import ContactSensors
from windup.hal.controller import PolicyInput
from windup.hal.joints import Array, Joint, Joints, Mask
from windup.hal.mirror import Mirror
from windup.hal.observation import BaseState, JointState, Observation
from windup.hal.torque_state import TorqueState

JOINTS = Joints(
    (
        Joint("waist", -1.0, 1.0, stiffness=20.0, damping=2.0, torque=8.0, velocity=5.0),
        Joint("l_hip", -1.0, 1.0, stiffness=10.0, damping=1.0, torque=4.0, velocity=5.0),
        Joint("l_knee", 0.0, 2.0, stiffness=10.0, damping=1.0, torque=4.0, velocity=5.0),
        Joint("r_hip", -1.0, 1.0, stiffness=10.0, damping=1.0, torque=4.0, velocity=5.0),
        Joint("r_knee", 0.0, 2.0, stiffness=10.0, damping=1.0, torque=4.0, velocity=5.0),
    )
)
N = len(JOINTS)
CONTACTS = ContactSensors(
    ("l_heel", "l_toe", "r_heel", "r_toe"),
    {"left_foot": ("l_heel", "l_toe"), "right_foot": ("r_heel", "r_toe")},
)
MIRROR = Mirror(np.array([0, 3, 4, 1, 2]), np.array([1.0, -1.0, 1.0, -1.0, 1.0]))

AIR = np.zeros(4)
L_TOE = np.array([0.0, 9.0, 0.0, 0.0])
R_HEEL = np.array([0.0, 0.0, 9.0, 0.0])
R_TOE = np.array([0.0, 0.0, 0.0, 9.0])


def gait(folder: Path, text: str, name: str = "test") -> Gait:
    """Return the gait that `text` describes."""
    path = folder / f"{name}.toml"
    path.write_text(text)
    return load_gait(path, JOINTS, CONTACTS, MIRROR)


def observation(
    time: float = 0.0,
    position: Array | None = None,
    contacts: Array = AIR,
    base: BaseState | None = None,
    age: Array | None = None,
) -> Observation:
    """Return an observation of the small robot."""
    zero = np.zeros(N)
    position = zero if position is None else position
    joints = JointState(position, zero, zero, zero, zero, zero if age is None else age)
    return Observation(time, joints, None, contacts, base)


def policy_state(contacts: Sequence[Array], pitch: float = 0.0, rate: float = 0.0) -> PolicyInput:
    """Return the state of as many small robots as there are rows of contacts."""
    m = len(contacts)
    orientation = np.array([np.cos(pitch / 2), 0.0, np.sin(pitch / 2), 0.0])
    return PolicyInput(
        np.zeros((m, N)),
        np.zeros((m, N)),
        np.tile(orientation, (m, 1)),
        np.tile([0.0, rate, 0.0], (m, 1)),
        np.array(contacts),
    )


@dataclass
class FakeClock:
    """A clock that is where it was told to be, and may be late."""

    time: float = 0.0
    late: dict[int, float] = field(default_factory=dict)
    asked: list[float] = field(default_factory=list)

    def now(self) -> float:
        return self.time

    def wait_until(self, time: float) -> None:
        self.asked.append(time)
        self.time = max(self.time, time) + self.late.get(len(self.asked), 0.0)


@dataclass
class FakeBackend:
    """Joints that are at once where they are told to be."""

    joints: Joints = JOINTS
    clock: FakeClock = field(default_factory=FakeClock)
    position: Array = field(default_factory=lambda: np.zeros(N))
    age: Array = field(default_factory=lambda: np.zeros(N))
    written: list[JointCommand] = field(default_factory=list)
    stuck: Mask = field(default_factory=lambda: np.zeros(N, dtype=bool))
    silent: Mask = field(default_factory=lambda: np.zeros(N, dtype=bool))
    powered: bool = True

    def connect(self) -> None: ...

    def configure(self) -> None: ...

    def request(self) -> None: ...

    def disconnect(self) -> None: ...

    def collect(self) -> Observation:
        return observation(self.clock.now(), self.position.copy(), age=self.age)

    def read(self) -> Observation:
        return self.collect()

    def write(self, command: JointCommand) -> JointCommand:
        self.written.append(command)
        self.position = command.position.copy()
        return command

    def set_torque(self, on: bool) -> TorqueState:
        self.powered = on
        return TorqueState((np.full(N, on) | self.stuck) & ~self.silent, self.silent)
