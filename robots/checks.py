"""Consistency checks of a robot.toml: within itself, and against its MJCF.

Every error is one line with the file, the key and, for an unknown name, the most similar one.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from math import isnan
from pathlib import Path

import mujoco

from windup.hal.errors import ConfigError, suggest
from windup.hal.families import family_of
from windup.hal.servos import servo_names
from windup.robots import mjcf
from windup.robots.couplings import coupling_mistakes
from windup.robots.imu import imu_mistakes
from windup.robots.limits import travel_mistakes
from windup.robots.records import Foot, JointEntry, RobotFile
from windup.robots.structure import mistakes

SLACK = 1e-6
"""Tolerance of limits for rounding, rad."""

TOUCH = mujoco.mjtSensor.mjSENS_TOUCH
IMU_SENSORS = {
    "gyro": mujoco.mjtSensor.mjSENS_GYRO,
    "accelerometer": mujoco.mjtSensor.mjSENS_ACCELEROMETER,
    "orientation": mujoco.mjtSensor.mjSENS_FRAMEQUAT,
}


def whole_steps(rate_hz: float, timestep: float) -> int | None:
    """Return the physics steps of `timestep` s in a period of `rate_hz`; None if not whole.

    >>> whole_steps(250.0, 0.002), whole_steps(300.0, 0.002)
    (2, None)
    """
    steps = 1.0 / (rate_hz * timestep)
    whole = round(steps)
    return whole if whole > 0 and abs(steps - whole) < 1e-6 else None


@dataclass(frozen=True)
class Checks:
    """The checks of one robot.

    Attributes:
        path: Path of its robot.toml, for messages.
        robot: The decoded robot.toml.
        model: The compiled MJCF.
    """

    path: Path
    robot: RobotFile
    model: mujoco.MjModel

    def run(self) -> None:
        """Run all checks.

        Raises:
            ConfigError: A check failed; the message is about the first one.
        """
        self._rate()
        self._joint_names()
        self._structure()
        self._no_limits()
        for joint in self.robot.joint:
            self._limits(joint)
            self._servo(joint)
        self._servo_ids()
        for key, mistake in coupling_mistakes(self.robot, self.model):
            self._fail(key, mistake)
        self._feet()
        self._imu()
        self._poses()
        self._stop()
        for key, mistake in self.robot.safety.mistakes(self.robot.drive.supply):
            self._fail(f"safety.{key}", mistake)

    @property
    def _feet_named(self) -> list[Foot]:
        return [entry.foot() for entry in self.robot.foot]

    def _rate(self) -> None:
        rate, timestep = self.robot.rate_hz, self.model.opt.timestep
        if whole_steps(rate, timestep) is None:
            self._fail("rate_hz", f"a period of 1/{rate:g} s is no whole number of physics steps")

    def _structure(self) -> None:
        bodies = mjcf.names(self.model, "body")
        self._known("base", "body", self.robot.base, bodies)
        self._known("torso", "body", self.robot.torso, bodies)
        for key, mistake in mistakes(self.robot, self.model):
            self._fail(key, mistake)

    def _joint_names(self) -> None:
        entries = [joint.name for joint in self.robot.joint]
        self._unique("joint", "joint", entries)
        for index, body in enumerate(self.model.jnt_bodyid.tolist()):
            if self.model.jnt_type[index] != mjcf.FREE and not self.model.joint(index).name:
                on = self.model.body(body).name
                self._fail("model", f"a joint of body {on!r} has no name in the MJCF: give it one")
        hinges = mjcf.hinge_names(self.model)
        for name in entries:
            self._known("joint", "MJCF hinge", name, hinges)
        for name in self.robot.passive:
            self._known("passive", "MJCF joint", name, mjcf.names(self.model, "joint"))
        for coupling in self.robot.coupling:
            key = f"coupling {coupling.joint!r}"
            self._known("coupling", "MJCF joint", coupling.joint, mjcf.names(self.model, "joint"))
            self._known(f"{key}: follows", "joint", coupling.follows, entries)

    def _no_limits(self) -> None:
        """Fail if there are joints without limits, and name all of them."""
        lost = [joint.name for joint in self.robot.joint if isnan(joint.upper - joint.lower)]
        if lost:
            names = ", ".join(repr(name) for name in lost)
            extended = 'mode = "extended" where a Dynamixel X shall turn on and on'
            self._fail(
                f"joint {names}",
                "no range in the MJCF, and no lower and upper here: give both, at most one turn "
                f"of its servo, or {extended}",
            )

    def _limits(self, joint: JointEntry) -> None:
        key = f"joint {joint.name!r}"
        for gain in ("stiffness", "damping"):
            if getattr(joint, gain) is None:
                self._fail(key, f"needs {gain}, here or in [drive]")
        if joint.lower >= joint.upper:
            self._fail(key, f"lower {joint.lower:g} is not below upper {joint.upper:g}")
        hinge = self.model.joint(joint.name)
        if not self.model.jnt_limited[hinge.id]:
            return  # the MJCF has no limits; those of robot.toml apply
        low, high = hinge.range
        if joint.lower < low - SLACK or joint.upper > high + SLACK:
            given = f"{joint.lower:g} to {joint.upper:g} rad"
            self._fail(key, f"{given} is wider than the MJCF's {low:g} to {high:g} rad")

    def _servo(self, joint: JointEntry) -> None:
        key = f"joint {joint.name!r}"
        if self.robot.drive.kind == "torque":
            if joint.servo or joint.bus or joint.id is not None or joint.mode == "extended":
                self._fail(key, 'has a servo, but drive.kind is "torque"')
            return
        if joint.servo is None or joint.bus is None or joint.id is None:
            self._fail(key, 'needs servo, bus and id: drive.kind is "servo"')
        self._known(f"{key}: servo", "servo", str(joint.servo), servo_names())
        self._known(f"{key}: bus", "bus", str(joint.bus), [bus.name for bus in self.robot.bus])
        self._bus(key, joint)
        for mistake in travel_mistakes(joint):
            self._fail(key, mistake)

    def _bus(self, key: str, joint: JointEntry) -> None:
        """Fail unless a servo's protocol and baud rate match its bus."""
        family = family_of(str(joint.servo))
        bus = next(bus for bus in self.robot.bus if bus.name == joint.bus)
        if family.protocol != bus.protocol:
            speaks = f'a {joint.servo} speaks "{family.protocol}"'
            self._fail(key, f'{speaks}, and bus {bus.name!r} has protocol "{bus.protocol}"')
        if bus.baud not in family.bauds:
            rates = ", ".join(map(str, sorted(family.bauds)))
            self._fail(f"bus {bus.name!r}: baud", f"a {joint.servo} has no {bus.baud}, but {rates}")

    def _servo_ids(self) -> None:
        self._unique("bus", "bus", [bus.name for bus in self.robot.bus])
        taken: dict[tuple[str | None, int], str] = {}
        for joint in self.robot.joint:
            if joint.id is None:
                continue
            other = taken.setdefault((joint.bus, joint.id), joint.name)
            if other != joint.name:
                both = f"{other!r} already has on bus {joint.bus!r}"
                self._fail(f"joint {joint.name!r}", f"has id {joint.id}, which {both}")

    def _feet(self) -> None:
        self._unique("foot", "foot", [foot.name for foot in self.robot.foot])
        self._unique("foot", "sensor", [s for foot in self._feet_named for s in foot.sensors])
        feet = self._feet_named
        if len(feet) == 2 and feet[0].side and feet[0].side == feet[1].side:
            one, other = (foot.name for foot in feet)
            self._fail("foot", f"{one!r} and {other!r} are both {feet[0].side}: give them a side")
        for foot in self._feet_named:
            key = f"foot {foot.name!r}"
            self._known(f"{key}: body", "body", foot.body, mjcf.names(self.model, "body"))
            self._known(f"{key}: site", "site", foot.site, mjcf.names(self.model, "site"))
            self._sole(key, foot)
            for sensor in foot.sensors:
                self._sensor(f"{key}: sensors", sensor, TOUCH)

    def _sole(self, key: str, foot: Foot) -> None:
        """Fail unless a foot's site is on its body."""
        site = self.model.site(foot.site)
        if site.bodyid[0] != self.model.body(foot.body).id:
            there = self.model.body(site.bodyid[0]).name
            self._fail(f"{key}: site", f"{foot.site!r} is on body {there!r}, not on {foot.body!r}")

    def _imu(self) -> None:
        imu = self.robot.imu
        if imu is None:
            return
        self._known("imu.site", "site", imu.site, mjcf.names(self.model, "site"))
        for key, mistake in imu_mistakes(imu, self.robot.bus):
            self._fail(key, mistake)
        for key, kind in IMU_SENSORS.items():
            if (name := getattr(imu, key)) is not None:
                self._sensor(f"imu.{key}", name, kind)

    def _poses(self) -> None:
        joints = {joint.name: joint for joint in self.robot.joint}
        for pose, angles in self.robot.poses.items():
            for name, angle in angles.items():
                self._known(f"poses.{pose}", "joint", name, joints)
                low, high = joints[name].lower, joints[name].upper
                if not low - SLACK <= angle <= high + SLACK:
                    limits = f"{low:g} to {high:g} rad"
                    self._fail(f"poses.{pose}.{name}", f"{angle:g} rad is outside {limits}")
            for name in joints.keys() - angles.keys():
                if not joints[name].lower <= 0.0 <= joints[name].upper:
                    self._fail(f"poses.{pose}", f"names no {name!r}, and 0 is outside its limits")

    def _stop(self) -> None:
        self._known("stance", "pose", self.robot.stance, self.robot.poses)
        if self.robot.crouch is not None:
            self._known("crouch", "pose", self.robot.crouch, self.robot.poses)
        elif self.robot.stop == "crouch":
            self._fail("stop", '"crouch" needs the key crouch: the name of a pose')
        fall = self.robot.fall
        if fall is None:
            return
        if fall.way and fall.reach is None:
            self._fail("fall.way", "needs fall.reach: how far outside its soles it can step, m")
        if fall.way and not self.robot.foot:
            self._fail("fall.way", "needs a [[foot]]: where the soles are tells when it falls")
        for way in fall.way:
            self._known("fall.way.pose", "pose", way.pose, self.robot.poses)

    def _sensor(self, key: str, name: str, kind: mujoco.mjtSensor) -> None:
        """Fail unless the MJCF has a sensor `name` of the given kind."""
        wanted = [
            other
            for other in mjcf.names(self.model, "sensor")
            if self.model.sensor(other).type[0] == kind
        ]
        self._known(key, f"{kind.name.removeprefix('mjSENS_').lower()} sensor", name, wanted)

    def _known(self, key: str, kind: str, name: str, known: Iterable[str]) -> None:
        known = tuple(known)
        if name not in known:
            self._fail(key, f"unknown {kind} {name!r}{suggest(name, known)}")

    def _unique(self, key: str, kind: str, given: list[str]) -> None:
        for name in given:
            if given.count(name) > 1:
                self._fail(key, f"{kind} {name!r} stands there twice")

    def _fail(self, key: str, message: str) -> None:
        raise ConfigError(f"{self.path}: {key}: {message}")
