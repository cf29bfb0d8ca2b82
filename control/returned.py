"""Check of what the `step` of a controller returned, before it is used."""

from windup.hal.command import JointCommand, check_shape
from windup.hal.errors import ControllerError


def returned_command(
    returned: object, controller: object, joints: int | None = None
) -> JointCommand:
    """Return what a controller's `step` returned, if it is a command.

    Args:
        returned: What it returned.
        controller: The controller, for the message.
        joints: Number n of joints that the command is to have; not checked if None.

    Raises:
        ControllerError: It is no `JointCommand`.
        UnsafeCommandError: It is a command for another number of joints.
    """
    if not isinstance(returned, JointCommand):
        raise ControllerError(f"{type(controller).__name__}.step {no_command(returned)}")
    if joints is not None:
        check_shape(returned.block, joints)
    return returned


def no_command(returned: object) -> str:
    """Return what is wrong with something that is no command, after "step"."""
    kind = "nothing" if returned is None else f"a {type(returned).__name__}"
    return f"returned {kind}; it should return JointCommand.of(joints, position=...)"
