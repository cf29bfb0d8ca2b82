"""Checks of the joints of a robot.toml: names, limits, servos, buses and ids."""

from collections.abc import Iterator
from math import isnan

import mujoco

from windup.hal.families import FAMILIES, families, family_of, is_servo, servo_model, servo_names
from windup.robots import mjcf
from windup.robots.limits import travel_mistakes
from windup.robots.mistake import SLACK, Mistake, check_known, check_unique
from windup.robots.records import JointEntry, RobotFile

GAINS = ("stiffness", "damping")


def name_mistakes(robot: RobotFile, model: mujoco.MjModel) -> Iterator[Mistake]:
    """Yield repeated names of joints, and names that do not exist in the MJCF."""
    entries = [joint.name for joint in robot.joint]
    yield from check_unique("joint", "joint", entries)
    for index, body in enumerate(model.jnt_bodyid.tolist()):
        if model.jnt_type[index] != mjcf.FREE and not model.joint(index).name:
            on = model.body(body).name
            yield "model", f"a joint of body {on!r} has no name in the MJCF: give it one"
    hinges, joints = mjcf.hinge_names(model), mjcf.names(model, "joint")
    for name in entries:
        yield from check_known("joint", "MJCF hinge", name, hinges)
    for name in robot.passive:
        yield from check_known("passive", "MJCF joint", name, joints)
    for coupling in robot.coupling:
        key = f"coupling {coupling.joint!r}"
        yield from check_known("coupling", "MJCF joint", coupling.joint, joints)
        yield from check_known(f"{key}: follows", "joint", coupling.follows, entries)


def joint_mistakes(robot: RobotFile, model: mujoco.MjModel) -> Iterator[Mistake]:
    """Yield mistakes in limits, gains and servos; defaults must be filled in."""
    hinges = mjcf.hinge_names(model)
    yield from _without_limits(robot, hinges)
    yield from _without_gains(robot)
    for joint in robot.joint:
        yield from _limit_mistakes(joint, model, joint.name in hinges)
        yield from _servo_mistakes(robot, joint)
    yield from _unknown_servos(robot)
    yield from _protocol_mistakes(robot)
    yield from _id_mistakes(robot)


def _without_limits(robot: RobotFile, hinges: tuple[str, ...]) -> Iterator[Mistake]:
    """Yield one mistake that names all joints without limits."""
    lost = [joint.name for joint in robot.joint if joint.name in hinges and _unlimited(joint)]
    if lost:
        names = ", ".join(repr(name) for name in lost)
        extended = 'mode = "extended" for a Dynamixel X that turns further'
        yield (
            f"joint {names}",
            "no range in the MJCF, and no lower and upper here: give both, at most one turn "
            f"of its servo, or {extended}",
        )


def _without_gains(robot: RobotFile) -> Iterator[Mistake]:
    """Yield one mistake that names all joints without stiffness or damping, and what would do."""
    lost = [joint for joint in robot.joint if None in (joint.stiffness, joint.damping)]
    if not lost:
        return
    gains = [gain for gain in GAINS if any(getattr(joint, gain) is None for joint in lost)]
    names = ", ".join(repr(joint.name) for joint in lost)
    at = "" if len(lost) == len(robot.joint) else f", or at joint {names}"
    yield "drive", f"give {' and '.join(gains)} in [drive]{at}{_own_gains(robot, lost[0])}"


def _own_gains(robot: RobotFile, joint: JointEntry) -> str:
    """Return the gains of a joint's servo as it is delivered, in brackets; "" without a servo."""
    if joint.servo is None or not is_servo(joint.servo):
        return ""
    servo, supply = servo_model(joint.servo), robot.drive.supply
    stiffness = servo.stiffness(servo.p_default, supply) * joint.ratio**2
    damping = servo.damping(supply) * joint.ratio**2
    return (
        f" (those of a {joint.servo} with its default P at {supply:g} V: "
        f"stiffness = {stiffness:.3g}, damping = {damping:.3g})"
    )


def _unlimited(joint: JointEntry) -> bool:
    return isnan(joint.upper - joint.lower)


def _limit_mistakes(joint: JointEntry, model: mujoco.MjModel, known: bool) -> Iterator[Mistake]:
    """Yield limits that are reversed or wider than the MJCF's."""
    key = f"joint {joint.name!r}"
    if joint.lower >= joint.upper:
        yield key, f"lower {joint.lower:g} is not below upper {joint.upper:g}"
    if not known or not model.jnt_limited[model.joint(joint.name).id]:
        return  # the MJCF has no limits; those of robot.toml apply
    low, high = model.joint(joint.name).range
    if joint.lower < low - SLACK or joint.upper > high + SLACK:
        given = f"{joint.lower:g} to {joint.upper:g} rad"
        yield key, f"{given} is wider than the MJCF's {low:g} to {high:g} rad"


def _servo_mistakes(robot: RobotFile, joint: JointEntry) -> Iterator[Mistake]:
    """Yield mistakes in servo, bus, id, mode and travel of a joint."""
    key, drive = f"joint {joint.name!r}", robot.drive.kind
    if drive == "torque":
        if joint.servo or joint.bus or joint.id is not None or joint.mode == "extended":
            yield key, 'has a servo, but drive.kind is "torque"'
        return
    if joint.servo is None or joint.bus is None or joint.id is None:
        yield key, 'needs servo, bus and id: drive.kind is "servo"'
    exists = joint.servo is not None and is_servo(joint.servo)
    if joint.bus is not None:
        yield from check_known(f"{key}: bus", "bus", joint.bus, [bus.name for bus in robot.bus])
    if exists:
        yield from _bus_mistakes(robot, joint, key)
        if not _unlimited(joint):
            yield from ((key, mistake) for mistake in travel_mistakes(joint))


def _unknown_servos(robot: RobotFile) -> Iterator[Mistake]:
    """Yield one mistake for each unknown servo, however many joints have it."""
    if robot.drive.kind == "torque":
        return
    for name in dict.fromkeys(joint.servo for joint in robot.joint if joint.servo is not None):
        if is_servo(name):
            continue
        joints = ", ".join(repr(joint.name) for joint in robot.joint if joint.servo == name)
        key = "drive.servo" if name == robot.drive.servo else f"joint {joints}: servo"
        yield from check_known(key, "servo", name, servo_names())


def _bus_mistakes(robot: RobotFile, joint: JointEntry, key: str) -> Iterator[Mistake]:
    """Yield a mistake if a servo's protocol or baud rate does not match its bus."""
    family = family_of(str(joint.servo))
    for bus in [bus for bus in robot.bus if bus.name == joint.bus][:1]:
        if family.protocol_name != bus.protocol:
            speaks = f'a {joint.servo} uses protocol "{family.protocol_name}"'
            yield key, f'{speaks}, and bus {bus.name!r} has protocol "{bus.protocol}"'
        elif bus.baud not in family.bauds:
            rates = ", ".join(map(str, sorted(family.bauds)))
            yield f"bus {bus.name!r}: baud", f"a {joint.servo} has no {bus.baud}, but {rates}"


def _protocol_mistakes(robot: RobotFile) -> Iterator[Mistake]:
    """Yield unknown protocols of buses."""
    own = {family.protocol_name for family in FAMILIES}
    for bus in robot.bus:
        if bus.protocol not in own:  # without importing what other distributions add
            names = {family.protocol_name for family in families()}
            yield from check_known(f"bus {bus.name!r}: protocol", "protocol", bus.protocol, names)


def _id_mistakes(robot: RobotFile) -> Iterator[Mistake]:
    """Yield repeated names of buses, and ids that two servos of a bus share."""
    yield from check_unique("bus", "bus", [bus.name for bus in robot.bus])
    taken: dict[tuple[str | None, int], str] = {}
    for joint in robot.joint:
        if joint.id is None:
            continue
        other = taken.setdefault((joint.bus, joint.id), joint.name)
        if other != joint.name:
            both = f"{other!r} already has on bus {joint.bus!r}"
            yield f"joint {joint.name!r}", f"has id {joint.id}, which {both}"
