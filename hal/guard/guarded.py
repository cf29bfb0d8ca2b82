"""The guard: wraps the backend, so that all commands of controllers are checked and clamped."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from math import isfinite
from threading import RLock

import numpy as np

from windup.hal.backend import Backend, Clock, Rearmable
from windup.hal.command import FIELDS, JointCommand, check_shape
from windup.hal.errors import GuardianError, PortError, UnsafeCommandError
from windup.hal.geometry.smooth_step import smooth_step
from windup.hal.guard.arming import check_health, read_fresh
from windup.hal.guard.limits import SafetyLimits, StopPolicy
from windup.hal.guard.presence_check import PresenceCheck
from windup.hal.guard.torque_off_check import check_torque_off
from windup.hal.guard.watch import HealthWatch
from windup.hal.heartbeat import no_heartbeat
from windup.hal.joints import Array, Flags, Joints, Mask
from windup.hal.observation import Observation
from windup.hal.torque_state import TorqueState

CROUCH_SECONDS = 1.5
TICK = 0.008
REPLUG_TIME = 2.0
"""Maximum time until a replugged port can be opened, s."""
POWERS = np.uint32(1) << np.arange(len(FIELDS), dtype=np.uint32)
"""Bit of each row of a command in `GuardedBackend.clamp_bits`."""


@dataclass
class GuardedBackend:
    """A backend wrapper that checks and clamps all commands, and counts the clamps.

    Attributes:
        backend: The guarded backend. It must not be used except through the guard.
        limits: Limits of commands, and of the age of states.
        stop_policy: What `stop` does: hold the pose, crouch and go limp, or go limp at once.
        crouch: (n,) pose of the crouch, rad.
        watch: Judges the health of every joint; None for joints without servos.
        clamps: Maps each row of a command to the number of commands clamped in it.
        clamp_counts: (5, n) number of commands in which each row was clamped at each joint.
        clamped_joints: (n,) number of commands in which each joint was clamped.
        clamp_bits: (n,) bits of the rows of the last command in which each joint was clamped; None
            if it was not clamped.
        heartbeat: Called with every command; feeds the guardian.
        lock: Held while the backend is used: between two runs, a thread holds an idle robot.
    """

    backend: Backend
    limits: SafetyLimits
    stop_policy: StopPolicy = "limp"
    crouch: Array | None = None
    watch: HealthWatch | None = None
    clamps: dict[str, int] = field(default_factory=lambda: dict.fromkeys(FIELDS, 0))
    clamp_counts: Array = field(init=False, repr=False)
    clamped_joints: Array = field(init=False)
    clamp_bits: Flags | None = field(default=None, init=False, repr=False)
    heartbeat: Callable[[], None] = field(init=False, repr=False)
    lock: RLock = field(default_factory=RLock, init=False, repr=False)
    _last: Observation | None = field(default=None, init=False, repr=False)
    _applied: JointCommand | None = field(default=None, init=False, repr=False)
    _driven: bool = field(default=False, init=False, repr=False)

    def __post_init__(self) -> None:
        self.clamp_counts = np.zeros((len(FIELDS), len(self.backend.joints)))
        self.clamped_joints = np.zeros(len(self.backend.joints))
        self.heartbeat = no_heartbeat
        self._buffer = np.empty_like(self.limits.lower)
        # An infinite value is not clamped where the limit is infinite, so it is checked for.
        self._unlimited = not np.isfinite([self.limits.lower, self.limits.upper]).all()
        self._presence = PresenceCheck(self.backend)
        # Bound methods, looked up once: they are called on every tick.
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
        """The last observation and the command in effect, or None while no command is."""
        return (self._last, self._applied) if self._last and self._applied else None

    def connect(self) -> None:
        """Open the backend."""
        self.backend.connect()

    def configure(self) -> None:
        """Apply the backend's settings."""
        self.backend.configure()

    def disconnect(self) -> None:
        """Close the backend."""
        self.backend.disconnect()

    def set_torque(self, on: bool) -> TorqueState:
        """Switch the torque of all joints and return what was read back.

        Raises:
            UnhealthyError: Torque was to go on, but a joint is beyond a stop level; nothing
                has been switched.
        """
        with self.lock:
            if on:
                self.check_before_arming()
            self._driven, self._applied = on, None
            state = self.backend.set_torque(on)
            if on:
                read_fresh(self.backend, self.limits.max_age)
            return state

    def rearm(self) -> TorqueState:
        """Switch torque on at the present pose after a port was lost; return what was read back.

        Raises:
            PortError: A port is still missing.
            HardwareError: The wiring differs from robot.toml, or a joint is unhealthy; torque
                stays off.
        """
        if not isinstance(self.backend, Rearmable):
            return self.set_torque(True)
        with self.lock:
            return self._rearm(self.backend)

    def _rearm(self, backend: Rearmable) -> TorqueState:
        self._last = self._applied = None
        until = self.clock.now() + REPLUG_TIME
        while True:
            self.backend.read()  # also reopens ports that have come back
            try:
                self.check_before_arming()
                self._driven = True
                state = backend.rearm()
                read_fresh(self.backend, self.limits.max_age)
                return state
            except PortError:
                if self.clock.now() >= until:
                    raise
            self.clock.wait_until(self.clock.now() + TICK)

    def request(self) -> None:
        """Request the state of every joint, without waiting for it."""
        self.backend.request()

    def read(self) -> Observation:
        """Return the present state (see `collect`)."""
        with self.lock:
            self.backend.request()
            return self.collect()

    def peek(self) -> Observation:
        """Return the present state without checking age, torque or health."""
        with self.lock:
            return self.backend.read()

    def collect(self) -> Observation:
        """Wait for the state last requested and return it.

        Raises:
            TorqueLostError: A joint has lost its torque since it was armed; raised once.
            PortError: A port is lost; raised once.
            StaleStateError: A joint has not answered for longer than `limits.max_age`.
            UnhealthyError: A joint under torque has been beyond a stop level for long enough.
        """
        observation = self._collect()
        self._last = observation
        self._presence.check(observation.joints.age, self.limits.max_age)
        if self.watch is not None:
            unwell = self.watch.update(observation, self._applied)
            if unwell is not None and (self._driven or self._applied is not None):
                raise self.watch.error(unwell)
        return observation

    def write(self, command: JointCommand) -> JointCommand:
        """Clamp `command` to the limits, send it, and return the command that was really applied.

        Raises:
            GuardianError: The guardian process has died or hangs; nothing was sent.
            UnsafeCommandError: A value is not finite, or the shape is wrong; nothing was sent.
        """
        self.heartbeat()
        block = command.block
        if block.shape != self._buffer.shape:
            check_shape(block, len(self.joints))
        if self._unlimited and not isfinite(block.sum()):
            self._check_finite(block)
        np.maximum(block, self.limits.lower, out=self._buffer)
        np.minimum(self._buffer, self.limits.upper, out=self._buffer)
        self.clamp_bits = None
        if not (self._buffer == block).all():
            self._count_clamps(block)
            command = JointCommand(self._buffer.copy())
        self._applied = real = self._write(command)
        return real

    def stop(
        self, policy: StopPolicy | None = None, skip_crouch: Callable[[], bool] = lambda: False
    ) -> TorqueState:
        """Carry out the stop policy and return the torque state that was read back.

        A robot with a joint that has lost its torque, or may have, goes limp at once: it would
        fall while crouching or holding its pose.

        Args:
            policy: Stop policy to use instead of the robot's own.
            skip_crouch: Polled during a crouch; if it returns true, torque goes off at once.

        Raises:
            TorqueOnError: Torque was switched off, but a joint read back as on.
            TorqueUnknownError: Torque was switched off, but a joint could not be read back.
        """
        with self.lock:
            return self._stop(policy or self.stop_policy, skip_crouch)

    def _stop(self, policy: StopPolicy, skip_crouch: Callable[[], bool]) -> TorqueState:
        if policy != "limp" and self._presence.has_lost_torque():
            policy = "limp"
        if policy == "hold":
            self._send(JointCommand.hold(self.joints, self._pose()))
            return TorqueState.known(np.ones(len(self.joints), dtype=bool))
        if policy == "crouch" and self.crouch is not None:
            self._move_smoothly(self._pose(), self.crouch, CROUCH_SECONDS, skip_crouch)
        state = self.set_torque(False)
        check_torque_off(state, self.joints)
        return state

    def check_before_arming(self) -> None:
        """Check the health of every joint before torque enable.

        Raises:
            UnhealthyError: A joint is beyond a stop level; nothing has been switched.
        """
        with self.lock:
            check_health(self.backend, self.watch, self.limits.max_age)

    def _pose(self) -> Array:
        last = self._last or self.read()
        return np.clip(last.joints.position, self.limits.lower[0], self.limits.upper[0])

    def _move_smoothly(
        self, start: Array, end: Array, seconds: float, skip_crouch: Callable[[], bool]
    ) -> None:
        """Move the targets from `start` to `end` (n,) rad along a smoothstep profile."""
        began = self.clock.now()
        while (now := self.clock.now()) < began + seconds and not skip_crouch():
            with suppress(GuardianError):  # the stop continues without a guardian
                self.heartbeat()
            pose = start + (end - start) * smooth_step((now - began) / seconds)
            self._send(JointCommand.hold(self.joints, pose))
            self.clock.wait_until(now + TICK)

    def _write(self, command: JointCommand) -> JointCommand:
        with self.lock:
            return self._send(command)

    def _check_finite(self, block: Array) -> None:
        """Raise if a value of `block` is not finite; a sum may overflow with finite values."""
        bad = np.argwhere(~np.isfinite(block))
        if bad.size:
            row, joint = bad[0]
            raise UnsafeCommandError(
                f"the controller commanded {FIELDS[row]} {block[row, joint]} for joint "
                f"{self.joints.names[joint]!r}; give finite values"
            )

    def _count_clamps(self, block: Array) -> None:
        """Count the clamps of `block`; raise if a value is not finite."""
        self._check_finite(block)
        changed = self._buffer != block
        self.note_clamps(changed)
        self.clamp_bits = POWERS @ changed

    def note_clamps(self, changed: Mask) -> None:
        """Count one command that was clamped where `changed` (5, n) is true, here or before."""
        for row in np.flatnonzero(changed.any(axis=1)):
            self.clamps[FIELDS[row]] += 1
        self.clamp_counts += changed
        self.clamped_joints += changed.any(axis=0)
