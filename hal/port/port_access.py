"""Explains why a user may not open a device, and gives the remedy, from its mode and groups."""

import grp
import os
import pwd
import stat
from contextlib import suppress
from typing import NamedTuple, Self

READ_WRITE = 0o6
RULE = 'SUBSYSTEM=="tty", GROUP="dialout", MODE="0660"'


class User(NamedTuple):
    """A user and the groups that count for access.

    Attributes:
        uid: User id.
        groups: Group ids of this process, set at login.
        member: Group ids that the user is a member of now.
    """

    uid: int
    groups: frozenset[int]
    member: frozenset[int]

    @classmethod
    def present(cls) -> Self:
        """Return the user of this process."""
        uid = os.geteuid()
        groups = frozenset([os.getegid(), *os.getgroups()])
        member = groups
        with suppress(KeyError):  # a user without an entry
            user = pwd.getpwuid(uid)
            member = frozenset(os.getgrouplist(user.pw_name, user.pw_gid))
        return cls(uid, groups, member)


def access_remedy(device: str) -> str:
    """Return why this process may not read and write `device`, with the remedy."""
    return permission_remedy(os.stat(device), User.present())


def permission_remedy(device: os.stat_result, person: User) -> str:
    """Return why `person` may not read and write a device with this `stat`, with the remedy."""
    mode, owner, group = device.st_mode, _user(device.st_uid), _group(device.st_gid)
    shown = f"it is {stat.filemode(mode)} {owner} {group}"
    if person.uid == 0 or _allowed(device, person):
        return f"{shown}, which allows it: a container, or a security module, forbids it"
    if person.uid == device.st_uid:
        return f"{shown}, and yours: chmod u+rw it"
    if device.st_gid == 0 or not _has(mode >> 3):
        return (
            f"{shown}, and joining a group would not help; is this the port of a servo adapter? "
            f"A udev rule can give it a group: {RULE}"
        )
    if device.st_gid in person.groups:
        return f"{shown}, but an access control list restricts it: see getfacl"
    if device.st_gid in person.member:
        return f"you have joined its group {group} since you logged in: log in again"
    return f"join its group: sudo usermod -aG {group} $USER, then log in again"


def _allowed(device: os.stat_result, person: User) -> bool:
    """Return whether the mode bits allow a person to read and write."""
    if person.uid == device.st_uid:
        return _has(device.st_mode >> 6)
    return _has(device.st_mode >> 3 if device.st_gid in person.groups else device.st_mode)


def _has(bits: int) -> bool:
    return bits & READ_WRITE == READ_WRITE


def _user(uid: int) -> str:
    with suppress(KeyError):
        return pwd.getpwuid(uid).pw_name
    return str(uid)


def _group(gid: int) -> str:
    with suppress(KeyError):
        return grp.getgrgid(gid).gr_name
    return str(gid)
