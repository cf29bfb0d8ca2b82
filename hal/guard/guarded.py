"""The guard: the only holder of a write handle, between every controller and every backend."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from math import isfinite
from threading import RLock

import numpy as np

from windup.hal.backend import Backend, Clock, Rearmable
from windup.hal.command import FIELDS, JointCommand
from windup.hal.errors import GuardianError, PortError, UnsafeCommandError
from windup.hal.geometry.smooth_step import smooth_step
from windup.hal.guard.arming import check_health, read_afresh
from windup.hal.guard.ending import check_off
from windup.hal.guard.limits import SafetyLimits, StopPolicy
from windup.hal.guard.presence import Presence
from windup.hal.guard.watch import HealthWatch
from windup.hal.heartbeat import no_heartbeat
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation
from windup.hal.torque_state import TorqueState

CROUCH_SECONDS = 1.5
TICK = 0.008
REPLUG_TIME = 2.0
"""What a port that was plugged in again may take until it can be opened, s."""


@dataclass
class GuardedBackend:
    """A backend whose commands are checked, clamped and counted on their way through.

    Attributes:
        backend: The guarded one. Nobody else should hold it.
        limits: What may pass.
        stop_policy: What `stop` does: hold the pose, crouch and go limp, or go limp at once.
        crouch: (n,) pose of the crouch, rad.
        watch: Judges the health of every joint; None for joints without servos.
        clamps: Clamp name to the number of commands it changed.
        clamped_joints: (n,) number of commands in which each joint was clamped.
        heartbeat: Called with every command, for whoever watches that commands come.
        lock: Held while the backend is used: a thread holds an idle robot between two runs.
    """

    backend: Backend
    limits: SafetyLimits
    stop_policy: StopPolicy = "limp"
    crouch: Array | None = None
    watch: HealthWatch | None = None
    clamps: dict[str, int] = field(default_factory=lambda: dict.fromkeys(FIELDS, 0))
    clamped_joints: Array = field(init=False)
    heartbeat: Callable[[], None] = field(init=False, repr=False)
    lock: RLock = field(default_factory=RLock, init=False, repr=False)
    _last: Observation | None = field(default=None, init=False, repr=False)
    _obeyed: JointCommand | None = field(default=None, init=False, repr=False)
    _driven: bool = field(default=False, init=False, repr=False)

    def __post_init__(self) -> None:
        self.clamped_joints = np.zeros(len(self.backend.joints))
        self.heartbeat = no_heartbeat
        self._buffer = np.empty_like(self.limits.lower)
        # Where a limit is infinite, clamping does not show that a value is.
        self._unlimited = not np.isfinite([self.limits.lower, self.limits.upper]).all()
        self._presence = Presence(self.backend)
        # Bound once: these run on every tick.
        self._send: Callable[[JointCommand], JointCommand] = self.backend.write
        self._collect: Callable[[], Observation] = self.backend.collect

    @property
    def joints(self) -> Joints:
        """The joints, in MJCF order."""
        return self.backend.joints

    @property
    def clock(self) -> Clock:
        """The backend's clock."""
        return self.backend.clock

    @property
    def last(self) -> tuple[Observation, JointCommand] | None:
        """What was seen last, and what the joints obey, while somebody drives them."""
        return (self._last, self._obeyed) if self._last and self._obeyed else None

    def connect(self) -> None:
        """Open the backend."""
        self.backend.connect()

    def configure(self) -> None:
        """Assert the backend's settings."""
        self.backend.configure()

    def disconnect(self) -> None:
        """Close the backend."""
        self.backend.disconnect()

    def set_torque(self, on: bool) -> TorqueState:
        """Switch the torque of all joints and return what was read back.

        Raises:
            UnhealthyError: Torque on, and a joint is unwell already; nothing has been switched.
        """
        with self.lock:
            if on:
                self.admit()
            self._driven, self._obeyed = on, None
            state = self.backend.set_torque(on)
            if on:
                read_afresh(self.backend, self.limits.max_age)
            return state

    def rearm(self) -> TorqueState:
        """Switch torque on at the present pose after a port was gone; return what was read back.

        Raises:
            PortError: A port is still gone.
            HardwareError: Something is not as wired, or a joint is unwell; torque stays off.
        """
        if not isinstance(self.backend, Rearmable):
            return self.set_torque(True)
        with self.lock:
            return self._rearm(self.backend)

    def _rearm(self, backend: Rearmable) -> TorqueState:
        self._last = self._obeyed = None
        until = self.clock.now() + REPLUG_TIME
        while True:
            self.backend.read()  # which opens what has come back
            try:
                self.admit()
                self._driven = True
                state = backend.rearm()
                read_afresh(self.backend, self.limits.max_age)
                return state
            except PortError:
                if self.clock.now() >= until:
                    raise
            self.clock.wait_until(self.clock.now() + TICK)

    def request(self) -> None:
        """Ask every joint for its state."""
        self.backend.request()

    def read(self) -> Observation:
        """Return the present state (see `collect`)."""
        with self.lock:
            self.backend.request()
            return self.collect()

    def peek(self) -> Observation:
        """Return the present state, however old it is and however unwell the joints are."""
        with self.lock:
            return self.backend.read()

    def collect(self) -> Observation:
        """Return the state last asked for.

        Raises:
            TorqueLostError: A joint has lost its torque since it was armed; said once.
            PortError: A port is gone; said once.
            StaleStateError: A joint has not answered for longer than `limits.max_age`.
            UnhealthyError: A joint that is driven has been beyond a stop level for long enough.
        """
        observation = self._collect()
        self._last = observation
        self._presence.check(observation.joints.age, self.limits.max_age)
        if self.watch is not None:
            unwell = self.watch.update(observation, self._obeyed)
            if unwell is not None and (self._driven or self._obeyed is not None):
                raise self.watch.error(unwell)
        return observation

    def write(self, command: JointCommand) -> JointCommand:
        """Clamp `command` into the limits, send it, and return what the joints really got.

        Raises:
            GuardianError: The process that would stop the robot is gone; nothing was sent.
            UnsafeCommandError: A value is not a number, or the shape is wrong.
        """
        self.heartbeat()
        block = command.block
        if block.shape != self._buffer.shape:
            raise UnsafeCommandError(
                f"a command of shape {block.shape} for {len(self.joints)} joints; "
                f"it has to be {self._buffer.shape}"
            )
        if self._unlimited and not isfinite(block.sum()):
            self._refuse(block)
        np.maximum(block, self.limits.lower, out=self._buffer)
        np.minimum(self._buffer, self.limits.upper, out=self._buffer)
        if not (self._buffer == block).all():
            self._count(block)
            command = JointCommand(self._buffer.copy())
        self._obeyed = real = self._write(command)
        return real

    def stop(
        self, policy: StopPolicy | None = None, hurry: Callable[[], bool] = lambda: False
    ) -> TorqueState:
        """Carry out the stop policy and return the torque as it was read back.

        A robot with a joint that has no torque, or may have none, goes limp at once: a crouch, or
        a pose that is held, would be a fall.

        Args:
            policy: What to do instead of the robot's own policy.
            hurry: Asked during a crouch: if true, torque goes off at once.

        Raises:
            TorqueOnError: Torque was told to go off and a joint read back as on.
            TorqueUnknownError: A joint could not be read back.
        """
        with self.lock:
            return self._stop(policy or self.stop_policy, hurry)

    def _stop(self, policy: StopPolicy, hurry: Callable[[], bool]) -> TorqueState:
        if policy != "limp" and self._presence.crippled():
            policy = "limp"
        if policy == "hold":
            self._send(JointCommand.hold(self.joints, self._pose()))
            return TorqueState.known(np.ones(len(self.joints), dtype=bool))
        if policy == "crouch" and self.crouch is not None:
            self._glide(self._pose(), self.crouch, CROUCH_SECONDS, hurry)
        state = self.set_torque(False)
        check_off(state, self.joints)
        return state

    def admit(self) -> None:
        """Look at every joint before torque comes on.

        Raises:
            UnhealthyError: A joint is beyond a stop level; nothing has been switched.
        """
        with self.lock:
            check_health(self.backend, self.watch, self.limits.max_age)

    def _pose(self) -> Array:
        last = self._last or self.read()
        return np.clip(last.joints.position, self.limits.lower[0], self.limits.upper[0])

    def _glide(self, start: Array, end: Array, seconds: float, hurry: Callable[[], bool]) -> None:
        """Move the targets from `start` to `end` (n,) rad along a smooth step."""
        began = self.clock.now()
        while (now := self.clock.now()) < began + seconds and not hurry():
            with suppress(GuardianError):  # a stop goes on without a guardian
                self.heartbeat()
            pose = start + (end - start) * smooth_step((now - began) / seconds)
            self._send(JointCommand.hold(self.joints, pose))
            self.clock.wait_until(now + TICK)

    def _write(self, command: JointCommand) -> JointCommand:
        with self.lock:
            return self._send(command)

    def _refuse(self, block: Array) -> None:
        """Say which value is not a number; a sum that overflows is none of them."""
        bad = np.argwhere(~np.isfinite(block))
        if bad.size:
            row, joint = bad[0]
            raise UnsafeCommandError(
                f"the controller asked joint {self.joints.names[joint]!r} for "
                f"{FIELDS[row]} {block[row, joint]}; refused"
            )

    def _count(self, block: Array) -> None:
        """Count the clamps of `block`, unless it is to be refused."""
        self._refuse(block)
        changed = self._buffer != block
        for row in np.flatnonzero(changed.any(axis=1)):
            self.clamps[FIELDS[row]] += 1
        self.clamped_joints += changed.any(axis=0)
